// Whether bodies are apart: a tree of boxes, then a direction between two bodies.

#include <kaboum/collide/body_tree.h>
#include <kaboum/collide/separation.h>

#include <iostream>

#include "box.h"

int main() {
  using namespace kaboum;
  const std::vector<geom::Mesh> shelf{box({0, 0, 0}, {1, 1, 0.1}), box({0, 0, 1}, {1, 1, 1.1})};
  const std::vector<geom::Mesh> gripper{box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})};
  const collide::BodyTree shelf_tree(shelf), gripper_tree(gripper);
  const geom::Transform between_boards{Eigen::Matrix3d::Identity(), {0.5, 0.5, 0.5}};
  const bool close = collide::any_pair(shelf_tree, gripper_tree, between_boards, [&](int i, int j) {
    return !collide::find_separating_direction(collide::SupportPoints(shelf[i]),
                                               collide::SupportPoints(gripper[j]), between_boards);
  });
  std::cout << "the gripper is " << (close ? "perhaps in contact" : "apart") << '\n';
  return close ? 1 : 0;
}

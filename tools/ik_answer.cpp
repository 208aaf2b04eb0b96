// What kaboum-ik prints and reports.
#include "ik_answer.h"

#include <Eigen/Geometry>
#include <cstdio>
#include <iostream>

namespace kaboum::tools {
namespace {

double shown(const IkAnswer& answer, bool degrees, std::size_t joint, double q) {
  return degrees && answer.arm.axes[joint].turns ? q / kDegree : q;
}

std::vector<std::string> singular_names(unsigned singular) {
  std::vector<std::string> names;
  if ((singular & kinematics::kShoulder) != 0) names.emplace_back("shoulder");
  if ((singular & kinematics::kElbow) != 0) names.emplace_back("elbow");
  if ((singular & kinematics::kWrist) != 0) names.emplace_back("wrist");
  return names;
}

}  // namespace

bool is_complete(const IkAnswer& answer) {
  return answer.form && answer.form->model_error.position < kExact &&
         answer.form->model_error.rotation < kExact;
}

Json answer_json(const IkAnswer& answer, bool degrees) {
  const Eigen::Quaterniond turn(answer.target.linear);
  const kinematics::Vec3& p = answer.target.translation;
  Json j = {{"method", answer.form ? "closed form" : "numeric"},
            {"complete", is_complete(answer)},
            {"joints", answer.joints},
            {"angles", degrees ? "degrees" : "radians"},
            {"pose", {p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z(), turn.w()}}};
  if (answer.form) {
    j["family"] = kinematics::name_of(answer.form->family);
    j["model_error"] = {{"position", answer.form->model_error.position},
                        {"rotation", answer.form->model_error.rotation}};
  }
  j["found"] = answer.found;
  j["solutions"] = Json::array();
  for (const IkAnswer::Row& row : answer.rows) {
    Json q = Json::array();
    for (std::size_t i = 0; i < row.q.size(); ++i) q.push_back(shown(answer, degrees, i, row.q[i]));
    j["solutions"].push_back({{"q", q},
                              {"within_limits", row.within},
                              {"singular", singular_names(row.singular)},
                              {"position_error", row.error.position},
                              {"rotation_error", row.error.rotation}});
  }
  return j;
}

void print_answer(const IkAnswer& answer, bool degrees) {
  std::string head;
  for (const std::string& joint : answer.joints) {
    if (!head.empty()) head += ',';
    head += joint;
  }
  std::cout << head << '\n';
  for (const IkAnswer::Row& row : answer.rows) {
    std::string line;
    for (std::size_t i = 0; i < row.q.size(); ++i) {
      char text[32];
      std::snprintf(text, sizeof text, "%s%.12g", i == 0 ? "" : ",",
                    shown(answer, degrees, i, row.q[i]));
      line += text;
    }
    for (const std::string& name : singular_names(row.singular)) line += "  # singular: " + name;
    if (!row.within) line += "  # outside the limits";
    std::cout << line << '\n';
  }
}

}  // namespace kaboum::tools

// A robot driver that has no robot, in C++: it is at once where it is told to go. What is sensed is
// the first of the values that are possible.
//
//     kaboum-plan run ... --robot 'build/release/bin/example-driver'
//
// A real one sends what `follow` gives to motors, and overrides close, open, sense and stop as well
// (docs/planning/drivers.md).

#include <kaboum/driver/driver.h>

#include <algorithm>
#include <iostream>
#include <map>

namespace {

class NoRobot final : public kaboum::driver::Driver {
 protected:
  void begin(const std::map<std::string, kaboum::driver::Robot>& robots,
             const std::map<std::string, kaboum::driver::Place>& /*objects*/) override {
    for (const auto& [name, robot] : robots) {
      q_[name] = robot.q;
      names_[name] = robot.joint_names;
    }
  }
  std::vector<kaboum::driver::ExecutedSample> move(const std::string& robot,
                                                   const kaboum::driver::Motion& motion) override {
    std::vector<kaboum::driver::ExecutedSample> out;
    constexpr int kSamples = 50;
    for (int k = 0; k <= kSamples; ++k) {
      const double time = motion.duration() * k / kSamples;
      out.push_back({time, motion.at(time).q});
    }
    q_[robot] = motion.points.back().q;
    return out;
  }
  void close(const std::string& robot, const std::string& /*link*/) override {
    if (gripper() == nullptr) return;  // it has no joints
    const std::vector<std::string>& names = names_[robot];
    for (std::size_t k = 0; k < gripper()->joint_names.size(); ++k) {
      const auto joint = std::find(names.begin(), names.end(), gripper()->joint_names[k]);
      q_[robot][static_cast<std::size_t>(joint - names.begin())] = gripper()->to[k];
    }
  }
  void open(const std::string& robot, const std::string& link) override { close(robot, link); }
  std::optional<std::vector<double>> where(const std::string& robot) override { return q_[robot]; }
  std::string sense(const std::string& /*fact*/, const std::vector<std::string>& values) override {
    return values.front();
  }

 private:
  std::map<std::string, std::vector<double>> q_;
  std::map<std::string, std::vector<std::string>> names_;  ///< of joints
};

}  // namespace

int main() try {
  NoRobot().run(std::cin, std::cout);
  return 0;
} catch (const std::exception& e) {
  std::cerr << "example-driver: " << e.what() << '\n';
  return 1;
}

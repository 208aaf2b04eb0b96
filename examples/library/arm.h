#pragma once

#include <fstream>
#include <string>

/// Writes the files of a small robot into the working folder. @return the URDF's name.
inline std::string write_arm() {
  std::ofstream("example-link.off") << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                       "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  std::ofstream("example-arm.urdf") << R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="1 1 0.1"/></geometry></collision></link>
  <link name="forearm"><collision><origin xyz="0 0 0.1" rpy="0.1 0.2 0.3"/>
    <geometry><mesh filename="example-link.off" scale="0.5 0.2 0.2"/></geometry></collision></link>
  <joint name="elbow" type="continuous">
    <parent link="base"/><child link="forearm"/><axis xyz="0 0 1"/></joint>
</robot>)";
  return "example-arm.urdf";
}

/// Writes a motion of it. @return the file's name.
inline std::string write_path() {
  std::ofstream("example-path.csv") << "elbow\n0\n0.5\n1.2\n";
  return "example-path.csv";
}

# shellcheck shell=sh disable=SC2016
# What README.md shows of the library is what examples/library/readme.cpp compiles and runs.
# readme.sh BIN MESHES SCHEMA
set -u
readme=$(dirname "$0")/../../README.md example=$(dirname "$0")/../../examples/library/readme.cpp
sed -n '/^```cpp$/,/^```$/p' "$readme" | grep -v -e '^```' -e '^$' >readme.lines
[ "$(wc -l <readme.lines)" -ge 8 ] || { echo "no C++ in README.md"; exit 1; }
other=$(grep -vxFf "$example" readme.lines) && { echo "not in examples/library/readme.cpp: $other"; exit 1; }
rm readme.lines

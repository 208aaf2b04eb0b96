# shellcheck shell=sh disable=SC2016
# What README.md and docs/cpp.md show of the library is what examples/library/readme.cpp compiles and runs.
# readme.sh BIN MESHES SCHEMA
set -u
root=$(dirname "$0")/../.. example=$(dirname "$0")/../../examples/library/readme.cpp
sed -n '/^```cpp$/,/^```$/p' "$root/README.md" "$root/docs/cpp.md" | grep -v -e '^```' -e '^$' >readme.lines
[ "$(wc -l <readme.lines)" -ge 12 ] || { echo "no C++ there"; exit 1; }
other=$(grep -vxFf "$example" readme.lines) && { echo "not in examples/library/readme.cpp: $other"; exit 1; }
rm readme.lines

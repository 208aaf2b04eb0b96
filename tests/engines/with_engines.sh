#!/bin/sh
# with_engines.sh SCRIPT ARGUMENT...: a script by the Python that has the engines; 77 where there is none.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=${KABOUM_ENGINES:-$here/../../build/engines}/bin/python
if [ ! -x "$python" ]; then
  echo "skipped: no engines in $python; scripts/setup --engines"
  exit 77
fi
script=$1
shift
exec "$python" "$here/$script" "$@"

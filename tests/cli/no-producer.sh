#!/bin/sh
# bound-verify and bmesh-replay judge what other programs make: nothing that makes it is in them.
# usage: no-producer.sh BIN
set -eu
for program in bound-verify bmesh-replay; do
  symbols=$(nm -C "$1/$program" | grep -c "kaboum::verify::") || true
  [ "$symbols" -gt 20 ] || { echo "$program: no symbols to look at" >&2; exit 1; }
  if nm -C "$1/$program" | grep -E "kaboum::(bmesh::(decimate|Decimat)|bcd::|sweep::|certify::)"; then
    echo "$program: a producer is linked" >&2
    exit 1
  fi
done

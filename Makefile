# What a newcomer types; the work is done by scripts/ and CMake.
.PHONY: help demo build test reproduce clean

help:
	@echo "make demo    simplify a bracket, check the result, draw it (into demo-output/)"
	@echo "make build   build everything (into build/release/)"
	@echo "make test    build everything and run the test suite"
	@echo "make reproduce  the thesis's tables and figures beside ours, on the models of KABOUM_MESHES (into reproduction/), kept in docs/;"
	@echo "             make reproduce QUICK=1: a part of it (into reproduction-quick/), which is not kept"
	@echo "make clean   remove build/ and demo-output/"

demo:
	@scripts/demo

build:
	@scripts/build

test:
	@scripts/test

reproduce:
ifdef QUICK
	@scripts/reproduce-thesis --quick --out reproduction-quick
else
	@scripts/reproduce-thesis --peers --keep
endif

clean:
	rm -rf build demo-output

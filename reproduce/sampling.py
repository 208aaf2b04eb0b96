"""Samples that meet geometric constraints: Figure 5.4."""

import csv

from calls import Calls

SAMPLES = 10000
THESIS = ("The thesis shows both histograms without numbers. Algorithm 3 as it is printed has no joint limits; "
          "what it finds is counted where it happens to be within them.")


def section(context, document):
    if context.collecting:
        return
    document.heading("Constraint sampling (Figure 5.4)")
    program = context.runner.programs.parent / "benchmarks" / "sampling-benchmark"
    if not program.is_file():
        document.paragraph("Left out: sampling-benchmark is not built; cmake --preset release "
                           "-DKABOUM_BUILD_BENCHMARKS=ON.")
        return
    call = Calls(context, "sampling")
    files = ["figure-5-4.svg", "sampling.csv"]
    if call("sampling", program, [2000 if context.quick else SAMPLES, *files], [], files) is None:
        return
    with open(call.folder / "sampling.csv", newline="", encoding="utf-8") as file:
        rows = [[r["scene"], r["method"], r["within_percent"], r["draws"], r["microseconds"]]
                for r in csv.DictReader(file)]
    document.paragraph(THESIS)
    document.table(["scene", "method", "within limits [%]", "draws per call", "µs per call"], rows)
    document.picture(call.folder / "figure-5-4.svg", "Samples by place on the table and by grasp angle")

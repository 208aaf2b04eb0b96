. "$(dirname "$0")/common.sh"
P=$BIN/kaboum-plan
DOMAINS=$MESHES/../examples/domains

for case in 'stacked 4 astar' 'stacked 4 bfs' 'force-sensing 5 dfs' 'bartender 3 greedy' 'circular-rearrange 3 bfs' \
  'bimanual-assembly 1 bfs' 'remove 5 ids'; do
  set -- $case
  "$DOMAINS/$1/make-problem" "$2" >problem.kpl || fail "make-problem $1"
  expect 0 'solved' "$P" solve "$DOMAINS/$1/domain.kpl" problem.kpl --search "$3" -o plan.json --report report.json
  shows 0 'valid' "$P" check "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json
  expect 0 '' "$P" show "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json
done
shows 0 'digraph' "$P" show "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json --output-format dot
shows 0 '<svg' "$P" show "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json --output-format svg
expect 0 '' "$P" show "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json -o plan.svg
expect 2 'plan.png: plans are drawn as' "$P" show "$DOMAINS/$1/domain.kpl" problem.kpl --plan plan.json -o plan.png
[ ! -e plan.png ] || fail "text was written to plan.png"
grep -q '<svg' plan.svg || fail "show -o plan.svg draws no SVG"
expect 2 'number above 0' "$P" solve "$DOMAINS/$1/domain.kpl" problem.kpl --timeout nan
expect 2 'number above 0' "$P" solve "$DOMAINS/$1/domain.kpl" problem.kpl --timeout -1

# The optimal plan of four stacked objects has seven moves; another problem's plan is invalid.
"$DOMAINS/stacked/make-problem" 4 >problem.kpl
expect 0 'longest path 7 ' "$P" solve "$DOMAINS/stacked/domain.kpl" problem.kpl --search astar -o four.json
"$DOMAINS/stacked/make-problem" 5 >five.kpl
expect 1 '' "$P" check "$DOMAINS/stacked/domain.kpl" five.kpl --plan four.json
sed 's/isHighest(o4)/isNonsense(o4)/' problem.kpl >broken.kpl
expect 3 'broken.kpl:' "$P" solve "$DOMAINS/stacked/domain.kpl" broken.kpl
expect 3 '' "$P" solve missing.kpl
expect 2 '' "$P" solve "$DOMAINS/stacked/domain.kpl" problem.kpl --search sideways
# No plan: proved, or only not inferred.
printf 'predicates: p, q\ninit: K(p), K(!q)\naction go preconds: K(q) effects: add(Kf, !p)\ngoal: K(q)\n' >no.kpl
expect 1 'unsolvable: every possibility was tried' "$P" solve no.kpl
printf 'predicates: p, q\ninit: K(!q)\naction go effects: K(p) => add(Kf, q), K(!p) => add(Kf, q)\ngoal: K(q)\n' >weak.kpl
expect 8 'not proved that there is none: an effect whose condition' "$P" solve weak.kpl -o weak.json
absent weak.json
# Possible worlds: effects that hang on what is not known, and their proof that there is no plan.
cat >stain.pddl <<'END'
(define (domain stain) (:constants a b c - illness)
 (:predicates (ill ?i - illness) (stained ?i - illness) (cured))
 (:action stain :effect (forall (?i - illness) (when (ill ?i) (stained ?i))))
 (:action inspect :parameters (?i - illness) :observe (stained ?i))
 (:action medicate :parameters (?i - illness) :precondition (ill ?i) :effect (cured)))
(define (problem p) (:domain stain) (:init (oneof (ill a) (ill b) (ill c))) (:goal (cured)))
END
expect 0 'solved' "$P" solve stain.pddl -o stain.json
shows 0 'valid' "$P" check stain.pddl --plan stain.json
sed 's/:observe (stained ?i)/:observe (cured)/' stain.pddl >blind.pddl
expect 1 'unsolvable: every possibility was tried' "$P" solve blind.pddl
shows 0 'whenever K(ill(?i))' "$P" convert stain.pddl --output-format kpl
expect 2 '' "$P"
"$DOMAINS/stacked/make-problem" 9 >nine.kpl
expect 7 '' "$P" solve "$DOMAINS/stacked/domain.kpl" nine.kpl --search bfs --max-memory 1M -o none.json
absent none.json
# The limit of memory holds for what a search takes besides states: lists of steps, and tables while they grow.
"$DOMAINS/stacked/make-problem" 14 >fourteen.kpl
for search in dfs bfs ids; do
  python3 - "$P" "$DOMAINS/stacked/domain.kpl" "$search" <<'END' || fail "$search: memory"
import os, subprocess, sys
program, domain, search = sys.argv[1:]
def peak(problem, limit):
    child = subprocess.Popen([program, "solve", domain, problem, "--search", search, "--max-memory", limit, "-o", "none.json"],
                             stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    status, usage = os.wait4(child.pid, 0)[1:]
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss * 1024
nothing = peak("nine.kpl", "1K")
taken = peak("fourteen.kpl", "20M")
assert nothing[0] == taken[0] == 7, (nothing, taken)
assert taken[1] - nothing[1] < 1.05 * 20 * 2**20, (nothing, taken)
END
done
# Plans that are damaged: where, and what to do.
head -c 200 four.json >cut.json
expect 3 '^kaboum-plan: cut.json: the JSON is cut short: it ends at line [0-9]*, column [0-9]*; write the plan again' \
  "$P" check "$DOMAINS/stacked/domain.kpl" problem.kpl --plan cut.json
sed '3s/:/;/' four.json >bad.json
expect 3 "bad.json: not JSON at line 3, column [0-9]*, near '.*;.*'; write the plan again" \
  "$P" show "$DOMAINS/stacked/domain.kpl" problem.kpl --plan bad.json
: >empty.json
expect 3 'empty.json: the JSON is cut short: it ends at line 1, column 1' "$P" check "$DOMAINS/stacked/domain.kpl" problem.kpl --plan empty.json
sed '3s/: *[^,]*/: 1e999/' four.json >big.json
expect 3 'big.json: a number in it is out of range' "$P" check "$DOMAINS/stacked/domain.kpl" problem.kpl --plan big.json
sed '3s/^/"version": 1,/' four.json >twice.json
expect 3 "twice.json: line [0-9]*, column [0-9]*: '[a-z]*' is given twice; write the plan again" \
  "$P" check "$DOMAINS/stacked/domain.kpl" problem.kpl --plan twice.json
python3 -c 'print("{\"format\": " + "[" * 200000 + "]" * 200000 + "}")' >deep.json
expect 3 'deep.json: more than 64 lists and objects in each other' \
  "$P" check "$DOMAINS/stacked/domain.kpl" problem.kpl --plan deep.json
# Commands that are misspelt, or lacking.
expect 2 "unknown command 'sovle'; did you mean 'solve'?" "$BIN/kaboum-plan" sovle x.kpl
expect 2 "unknown command 'x.kpl'; commands: solve, check, show, run, page, convert" "$BIN/kaboum-plan" x.kpl
expect 2 'a command is to come first: solve, check' "$BIN/kaboum-plan"
expect 2 'unknown option --tre; did you mean --tree?' "$BIN/kaboum-plan" solve x.kpl --tre
# The example of docs/planning/language.md, as it stands there.
LANGUAGE=$MESHES/../docs/planning/language.md
block() { awk -v n="$1" '/^### /{on = /to be run/} on && /^```/{i++; next} on && i == 2 * n - 1' "$LANGUAGE"; }
block 1 >shelf.kpl
block 2 >told.txt
[ -s told.txt ] || fail "no example in $LANGUAGE"
expect 0 'solved' "$P" solve shelf.kpl -o plan.json
shows 0 'valid' "$P" check shelf.kpl --plan plan.json
expect 0 '' "$P" show shelf.kpl --plan plan.json -o shown.txt
cmp -s told.txt shown.txt || fail "another plan than docs/planning/language.md has: $(cat shown.txt)"
finish

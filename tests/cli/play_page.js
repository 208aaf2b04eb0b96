// Plays all steps of a page of kaboum-plan show --html without drawing: node play_page.js PAGE PLAYER_FOLDER
// The page's own code has to come to the states that the plan states, from one step to the next.
'use strict';
const fs = require('fs');
const vm = require('vm');
const assert = require('assert');

const page = fs.readFileSync(process.argv[2], 'utf8');
const scripts = [...page.matchAll(/<script([^>]*)>\n?([^]*?)<\/script>/g)];
assert.strictEqual(scripts.length, 5, 'data and four scripts');
const data = JSON.parse(scripts[0][2]);
for (const [, , code] of scripts.slice(1)) new vm.Script(code);  // throws where it is no JavaScript
const sources = ['scene.js', 'view.js', 'cell.js', 'player.js'].map((name) => require('path').resolve(process.argv[3], name));
sources.forEach((file, i) => assert.strictEqual(scripts[i + 1][2].trim(), fs.readFileSync(file, 'utf8').trim()));
const S = require(sources[0]);

assert.strictEqual(data.kaboum_player, 1);
const seen = new Set();
let ends = 0, most = 0, moved = 0;
// Every way that a step can be reached, once.
(function play(choices) {
  const played = S.branch(data, choices);
  const fresh = played.steps.slice(choices.length ? choices.length - 1 : 0);
  for (const step of fresh) {
    const gap = S.gap(data, step);
    most = Math.max(most, gap);
    assert(gap < 1e-6, `step ${step.number} ends ${gap} from where the plan says`);
    for (const time of [step.begin, (step.begin + step.end) / 2, step.end - 1e-9]) {
      const {state} = S.at(data, played, time);
      for (const shape of data.shapes) {
        const pose = S.shapePose(data, state, shape);
        assert(pose === null || pose.every(Number.isFinite), `${shape.name} is nowhere`);
      }
    }
    for (const part of step.parts) {
      const start = part.state.q[part.motion.robot], path = part.motion.path;
      assert.deepStrictEqual(path[0], start, 'a path begins where its robot is');
      moved += path.length > 1 ? 1 : 0;
    }
  }
  const end = S.at(data, played, played.duration).state, last = played.steps[played.steps.length - 1];
  assert.strictEqual(end, data.states[data.steps[last.number].ways[last.way].after]);
  ++ends;
  played.steps.forEach((step, index) => {
    if (index < choices.length) return;
    data.steps[step.number].ways.forEach((way, k) => {
      const key = `${step.number} ${k}`;
      if (k === step.way || seen.has(key)) return;
      seen.add(key);
      play([...played.steps.slice(0, index).map((s) => s.way), k]);
    });
  });
})([]);
// Bodies are closed meshes with numbers.
let triangles = 0;
for (const shape of data.shapes)
  for (const body of [...shape.bodies, ...(shape.exact ? [shape.exact] : [])]) {
    const points = S.decode(body.points, Float32Array), corners = S.decode(body.triangles, Uint32Array);
    assert(points.length % 3 === 0 && points.every(Number.isFinite) && corners.length % 3 === 0 && corners.length > 0);
    assert(corners.every((c) => 3 * c < points.length));
    triangles += corners.length / 3;
  }
assert(S.choicesTo(data, (step) => step === data.steps[data.steps.length - 1]) !== null);
const unplanned = data.steps.flatMap((step) => step.ways).filter((way) => way.unplanned);
for (const way of unplanned) assert(way.next === null && way.outcome, 'an outcome that is left out is one, and an end');
console.log(`${data.steps.length} steps, ${ends} branches, ${unplanned.length} left out, ${moved} motions, ${triangles} triangles, at most ${most} apart`);

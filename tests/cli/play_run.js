// Plays the page of a run without drawing: node play_run.js PAGE PLAYER_FOLDER
// What the page's own code makes of motions, and of what is taken and let go, has to be where the run says that things
// are at its next step.
'use strict';
const fs = require('fs');
const vm = require('vm');
const path = require('path');
const assert = require('assert');

const page = fs.readFileSync(process.argv[2], 'utf8');
const scripts = [...page.matchAll(/<script([^>]*)>\n?([^]*?)<\/script>/g)];
const sources = ['scene.js', 'view.js', 'cell.js', 'run.js', 'follow.js'].map((name) => path.resolve(process.argv[3], name));
assert.strictEqual(scripts.length, 1 + sources.length, 'data and scripts');
for (const [, , code] of scripts.slice(1)) new vm.Script(code);  // throws where it is no JavaScript
sources.forEach((file, i) => assert.strictEqual(scripts[i + 1][2].trim(), fs.readFileSync(file, 'utf8').trim()));
assert(!/(src|href)="(?!data:)/.test(page), 'nothing is fetched');
const ids = new Set([...page.matchAll(/ id="([a-z]+)"/g)].map(([, id]) => id));
for (const [, , code] of scripts.slice(3))
  for (const [, id] of code.matchAll(/\$\('([a-z]+)'\)/g)) assert(ids.has(id), `the page has no ${id}`);
const data = JSON.parse(scripts[0][2]);
assert.strictEqual(data.kaboum_run, 1);
const S = require(sources[0]), R = require(sources[3]);

const run = R.create(data);
let most = 0, compared = 0, told = 0;
const known = new Set();
const state = () => (run.at(run.duration) || {state: data.states[0]}).state;
for (const event of data.events) {
  const before = state(), first = compared === 0;
  assert(run.add(event), `an event is not understood: ${JSON.stringify(event).slice(0, 200)}`);
  for (const fact of event.gone || []) assert(known.delete(fact), `${fact} is lost, and was not known`);
  for (const fact of event.learned || []) { assert(!known.has(fact), `${fact} is learned twice`); known.add(fact); }
  // Who follows sees a motion go on since it was told, and no farther than to its end; else the end.
  const motion = event.told && event.told.do === 'move' ? run.running.moment : null;
  assert.strictEqual(run.now(0), motion ? motion.begin : run.duration);
  assert.strictEqual(run.now(1e9), motion ? motion.end : run.duration);
  if (motion) ++told;
  if (event.step === undefined && event.step_done === undefined) continue;
  const now = state();
  if (!first) {
    now.q.forEach((q, r) => q.forEach((x, j) => { most = Math.max(most, Math.abs(x - before.q[r][j])); }));
    now.places.forEach((place, object) => {
      const was = S.objectPose(data, before, object), is = S.objectPose(data, now, object);
      if (was && is) is.forEach((x, i) => { most = Math.max(most, Math.abs(x - was[i])); });
    });
  }
  ++compared;
  const {moment} = run.at(run.duration);
  assert.deepStrictEqual(moment.known, [...known].sort(), 'what is known');
  assert(run.plans[moment.plan], 'a step of a plan that was not told of');
  assert(run.plans[moment.plan].svg.includes(`id="node-${moment.node}"`), 'a node that is not drawn');
}
assert(most < 1e-5, `a step begins ${most} from where motions have led`);
assert(told > 0 && run.moments.filter((m) => m.motion).length === told, 'each motion is shown');
for (const row of run.rows) assert(!row.text.startsWith('an e'), row.text);
// Forwards in time, everywhere somewhere.
let last = 0;
for (const moment of run.moments) {
  assert(moment.begin === last && moment.end >= moment.begin);
  last = moment.end;
  for (const time of [moment.begin, (moment.begin + moment.end) / 2])
    for (const shape of data.shapes) {
      const pose = S.shapePose(data, run.at(time).state, shape);
      assert(pose === null || pose.every(Number.isFinite), `${shape.name} is nowhere`);
    }
}
assert.strictEqual(last, run.duration);
console.log(JSON.stringify({events: run.events, rows: run.rows.map((row) => [row.kind, row.text, row.note]), known: [...known].sort(),
                            ended: run.ended, verdict: run.verdict && run.verdict.verdict, most, duration: run.duration}));

// A preview's data without drawing: node check_preview.js PAGE PLAYER_FOLDER LARGEST
// The page is whole and needs nothing else; no distance exceeds LARGEST, which is certified (-: there is no such bound);
// distances of some corners are what is found here by looking at all triangles, at many places of a path.
'use strict';
const fs = require('fs'), path = require('path'), vm = require('vm'), assert = require('assert');

const [file, player, bound] = process.argv.slice(2);
const page = fs.readFileSync(file, 'utf8');
assert(!page.includes('{{') && !/\b(src|href)=/.test(page.replace(/<script[^]*?<\/script>/g, '')), 'something from elsewhere');
assert(!page.includes('http'), 'an address');
const scripts = [...page.matchAll(/<script([^>]*)>\n?([^]*?)<\/script>/g)];
const names = ['scene.js', 'view.js', 'preview.js'];
assert.strictEqual(scripts.length, 1 + names.length, 'data and scripts');
names.forEach((name, i) => {
  new vm.Script(scripts[i + 1][2]);
  assert.strictEqual(scripts[i + 1][2].trim(), fs.readFileSync(path.join(player, name), 'utf8').trim(), name);
});
const ids = new Set([...page.replace(/<script[^]*?<\/script>/g, '').matchAll(/\bid="(\w+)"/g)].map((m) => m[1]));
for (const [, id] of scripts[3][2].matchAll(/\$\('(\w+)'\)/g)) assert(ids.has(id) || id === 'data', `nothing is called ${id}`);

const S = require(path.resolve(player, 'scene.js'));
const data = JSON.parse(scripts[0][2]);
assert.strictEqual(data.kaboum_preview, 1);
assert(data.facts.length >= 2 && data.facts.every(([name, words]) => name && words), 'words');
let most = -1, triangles = 0, bodies = 0;
for (const layer of data.layers) {
  assert(layer.name && layer.shapes.length > 0);
  bodies += layer.bodies ? layer.shapes.length : 0;
  for (const shape of layer.shapes) {
    const {points, triangles: corners, values} = S.mesh(shape);
    assert(points.length % 3 === 0 && points.every(Number.isFinite) && corners.length % 3 === 0 && corners.length > 0);
    assert(corners.every((c) => 3 * c < points.length));
    assert(!values || (values.length === points.length / 3 && values.every((v) => v <= 1 && (v >= 0 || v === -1))));
    if (values) most = values.reduce((m, v) => Math.max(m, v), most);
    if (!data.robot) assert(points.every((x) => Math.abs(x) < 0.51), 'not at the origin');
    assert((shape.link === undefined) === !data.robot || layer.result);
    triangles += corners.length / 3;
  }
}
if (data.robot) {
  for (const part of [0, 0.3, 1]) {
    const poses = S.forward(data.robot, S.pathAt(data.path, part));
    for (const layer of data.layers)
      for (const {link} of layer.shapes) assert(link === undefined || poses[link].every(Number.isFinite));
  }
  assert.deepStrictEqual(S.pathAt(data.path, 1), data.path[data.path.length - 1]);
  assert.deepStrictEqual(S.pathAt(data.path, 0), data.path[0]);
}
assert(data.largest > 0 && most > 0.99, 'distances');
if (bound !== '-') assert(data.largest <= Number(bound) * (1 + 1e-6), `${data.largest} is more than the certified ${bound}`);

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const ofLine = (p, a, b) => {
  const d = minus(b, a), t = Math.max(0, Math.min(1, dot(minus(p, a), d) / (dot(d, d) || 1)));
  return Math.hypot(...minus(p, a.map((x, k) => x + t * d[k])));
};
/// From a point to a triangle: above it to its plane, else to its sides.
function distance(p, [a, b, c]) {
  const u = minus(b, a), v = minus(c, a), n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const w = minus(p, a), uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v), d = uu * vv - uv * uv;
  const s = (wu * vv - wv * uv) / d, t = (wv * uu - wu * uv) / d;
  if (d > 0 && s >= 0 && t >= 0 && s + t <= 1) return Math.abs(dot(w, n)) / Math.hypot(...n);
  return Math.min(ofLine(p, a, b), ofLine(p, b, c), ofLine(p, c, a));
}
/// The layers that a layer's distances are from.
function others(layer) {
  const rest = data.layers.filter((l) => l !== layer && (l.result !== layer.result || data.layers.every((x) => x.result)));
  return layer.result ? rest : rest.slice(-1);
}
const kPlaces = 80, kCorners = 30;
let looked = 0, near = 0;
for (const layer of data.layers) {
  const from = others(layer).flatMap((l) => l.shapes).map((shape) => {
    const {points, triangles: corners} = S.mesh(shape), corner = (i) => [...points.subarray(3 * i, 3 * i + 3)];
    const list = [];
    for (let t = 0; t < corners.length; t += 3) list.push([0, 1, 2].map((k) => corner(corners[t + k])));
    return {link: shape.link, list};
  });
  const candidates = layer.shapes.filter((s) => s.values).flatMap((shape) => {
    const {points, values} = S.mesh(shape);
    return [...values].map((value, i) => ({value, link: shape.link, p: [...points.subarray(3 * i, 3 * i + 3)]})).filter((c) => c.value >= 0);
  });
  for (let i = 0; i < candidates.length; i += Math.max(1, Math.floor(candidates.length / kCorners))) {
    const {p, value, link} = candidates[i];
    let least = Infinity;
    const moves = data.robot && data.path.length > 1;
    for (let k = 0; k <= (moves ? kPlaces : 0); ++k) {
      const poses = data.robot ? S.forward(data.robot, S.pathAt(data.path, k / kPlaces)) : [];
      for (const shape of from) {
        if (link !== undefined && shape.link !== link) continue;  // both are in the link's frame
        const local = link === undefined && shape.link !== undefined ? S.inverse(poses[shape.link]) : S.identity;
        const q = [0, 1, 2].map((r) => local[9 + r] + dot(local.slice(3 * r, 3 * r + 3), p));
        for (const t of shape.list) least = Math.min(least, distance(q, t));
      }
    }
    // Along a path fewer places are looked at here, but every link.
    const says = value * data.largest, is = least * data.scale, slack = 1e-4 * data.largest + 1e-6 * data.scale;
    assert(is <= says + (moves ? 0.2 * data.largest : slack), `${layer.name}: ${says} is said of a corner that is ${is} away`);
    if (!moves) assert(is >= says - slack, `${layer.name}: ${says} is said of a corner that is only ${is} away`);
    ++looked;
    near += Math.abs(is - says) < 0.1 * data.largest ? 1 : 0;
  }
}
assert(looked > 20 && near > 0.8 * looked, `${near} of ${looked} distances are as found here`);
console.log(`${data.layers.length} layers, ${bodies} bodies, ${triangles} triangles, at most ${data.largest}`);

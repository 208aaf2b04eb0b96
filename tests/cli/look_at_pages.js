// Opens pages in headless Chromium, all in one window, and compares what is seen with what their data say, drawn by a
// program of its own:
//   node look_at_pages.js CHROMIUM SCENE.JS PICTURE.PNG [FAULT:]PAGE#CONTROL=VALUE&...
// The controls are those of the page's address. Checked: nothing on the console; the outline; and, where nothing is
// transparent, the colour of each pixel, up to how light it is. FAULT is what has to be found: outline, colours or
// console. whole:PAGE is looked at with words and controls round it, without being compared.
'use strict';
const fs = require('fs'), path = require('path'), zlib = require('zlib'), assert = require('assert');
const {spawnSync} = require('child_process');

const [chromium, scene, picture, ...words] = process.argv.slice(2);
const S = require(path.resolve(scene)), R = require(path.join(path.dirname(path.resolve(scene)), 'run.js'));
const kWidth = 480, kHeight = 360, kColumns = 3;  // of a page in the window

const looks = words.map((word, index) => {
  const [, fault, file, controls] = /^(?:(\w+):)?([^#]*)#?(.*)$/.exec(word);
  const data = JSON.parse(/<script id="data"[^>]*>([^]*?)<\/script>/.exec(fs.readFileSync(file, 'utf8'))[1]);
  return {word, fault, file: path.resolve(file), data, controls: new Map(controls.split('&').filter((c) => c).map((c) => c.split('='))),
          left: kWidth * (index % kColumns), top: kHeight * Math.floor(index / kColumns)};
});

// What is drawn ---------------------------------------------------------------------------------

const palette = [[0.36, 0.54, 0.77], [0.93, 0.6, 0.29], [0.45, 0.69, 0.42], [0.79, 0.43, 0.41], [0.61, 0.5, 0.74],
                 [0.66, 0.52, 0.42], [0.86, 0.55, 0.74], [0.55, 0.6, 0.35], [0.38, 0.7, 0.74]];
const robots = [[0.68, 0.7, 0.73], [0.86, 0.72, 0.5], [0.62, 0.75, 0.66], [0.76, 0.66, 0.76]];
const viridis = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98],
                 [173, 220, 48], [253, 231, 37]].map((c) => c.map((x) => x / 255));
const grey = [0.72, 0.72, 0.72];
const heat = (x) => {
  const at = Math.min(Math.floor(8 * x), 7), f = 8 * x - at;
  return viridis[at].map((c, i) => c + f * (viridis[at + 1][i] - c));
};

const boxMiddle = (points) => [0, 1, 2].map((k) => {
  let low = Infinity, high = -Infinity;
  for (let i = k; i < points.length; i += 3) { low = Math.min(low, points[i]); high = Math.max(high, points[i]); }
  return (low + high) / 2;
});

/// Of a plan's page or a run's, at a time.
function stateOf(data, time) {
  if (data.kaboum_player) return S.at(data, S.branch(data, []), time).state;
  const run = R.create(data);
  data.events.forEach(run.add);
  return run.at(time).state;
}

/// Triangles in the world: corners and how each is coloured, of what the controls show.
function trianglesOf({data, controls}) {
  const out = [];
  const add = (bodies, pose, colourOf, explode) => {
    const meshes = bodies.map(S.mesh), middles = meshes.map((m) => boxMiddle(m.points)), all = boxMiddle(middles.flat());
    meshes.forEach(({points, triangles, values}, b) => {
      const place = (i) => {
        const p = [0, 1, 2].map((k) => points[3 * i + k] + explode * (middles[b][k] - all[k]));
        return [0, 1, 2].map((k) => pose[3 * k] * p[0] + pose[3 * k + 1] * p[1] + pose[3 * k + 2] * p[2] + pose[9 + k]);
      };
      for (let t = 0; t < triangles.length; t += 3) {
        const at = [...triangles.subarray(t, t + 3)];
        out.push({corners: at.map(place), values: values ? at.map((i) => values[i]) : null, colour: colourOf(b)});
      }
    });
  };
  if (data.kaboum_player || data.kaboum_run) {
    const state = stateOf(data, Number(controls.get('t') || 0)), what = controls.get('shapes') || 'sets';
    for (const shape of data.shapes) {
      const pose = S.shapePose(data, state, shape);
      if (pose) add(what === 'exact' ? [shape.exact] : shape.bodies, pose,
                    () => shape.robot !== undefined ? robots[shape.robot % 4] : palette[shape.object % 9], Number(controls.get('explode') || 0));
    }
    return {list: out, opaque: true};
  }
  const place = (data.variables || []).map((variable, i) => controls.has('joint' + i) ? Number(controls.get('joint' + i)) : variable.value);
  const links = !data.robot ? [] : S.forward(data.robot, data.variables ? place : controls.get('time') === '1' ? data.path[data.path.length - 1] : data.path[0]);
  const colours = controls.get('colours') || 'distance';
  let opaque = true, number = 0;
  data.layers.forEach((layer, index) => {
    const mode = controls.get('layer' + index) || layer.view;
    const byLink = new Map();
    for (const shape of layer.shapes) byLink.set(shape.link, [...(byLink.get(shape.link) || []), shape]);
    for (const [link, shapes] of byLink) {
      const first = number;
      number += shapes.length;
      if (mode === 'hidden') continue;
      opaque = opaque && mode === 'shown';
      const plain = layer.result && !(colours === 'distance' && layer.distances) ? palette[index % 9] : grey;
      add(colours === 'distance' ? shapes : shapes.map((s) => ({...s, values: undefined})), link === undefined ? S.identity : links[link],
          (b) => colours === 'bodies' && layer.bodies ? palette[(first + b) % 9] : plain, layer.bodies ? Number(controls.get('explode') || 0) : 0);
    }
  });
  return {list: out, opaque};
}

/// An eye that sees all of them from one side, as an address says it.
function eyeFor(list) {
  const points = list.flatMap((t) => t.corners.flat()), target = boxMiddle(points);
  let radius = 0;
  for (let i = 0; i < points.length; i += 3) radius = Math.max(radius, Math.hypot(...target.map((x, k) => points[i + k] - x)));
  return {target, distance: 3.2 * radius, yaw: -0.7, pitch: 0.5};
}

/// Calls visit(pixel, depth, weights of the corners) for the pixels of triangles, in perspective with 0.7 rad from top to
/// bottom.
function eachPixel(list, eye, width, height, visit) {
  const c = Math.cos(eye.pitch), back = [c * Math.cos(eye.yaw), c * Math.sin(eye.yaw), Math.sin(eye.pitch)];
  const right = [-Math.sin(eye.yaw), Math.cos(eye.yaw), 0];
  const up = [-Math.sin(eye.pitch) * Math.cos(eye.yaw), -Math.sin(eye.pitch) * Math.sin(eye.yaw), Math.cos(eye.pitch)];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const scale = height / 2 / Math.tan(0.35);
  for (const t of list) {
    const p = t.corners.map((corner) => {
      const d = corner.map((x, k) => x - eye.target[k]), z = eye.distance - dot(d, back);
      return [width / 2 + scale * dot(d, right) / z, height / 2 - scale * dot(d, up) / z, 1 / z];
    });
    const area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
    if (Math.abs(area) < 1e-12) continue;
    const range = (k, most) => [Math.max(0, Math.floor(Math.min(...p.map((x) => x[k])) - 0.5)), Math.min(most - 1, Math.ceil(Math.max(...p.map((x) => x[k]))))];
    const [x0, x1] = range(0, width), [y0, y1] = range(1, height);
    for (let y = y0; y <= y1; ++y)
      for (let x = x0; x <= x1; ++x) {
        const side = (a, b) => (b[0] - a[0]) * (y + 0.5 - a[1]) - (x + 0.5 - a[0]) * (b[1] - a[1]);
        const w = [side(p[1], p[2]), side(p[2], p[0]), side(p[0], p[1])].map((s) => s / area);
        if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0)) continue;
        const near = w[0] * p[0][2] + w[1] * p[1][2] + w[2] * p[2][2];
        visit(t, y * width + x, 1 / near, w.map((s, k) => s * p[k][2] / near));
      }
  }
}

/// The colours that each pixel may have: of the nearest triangle, and of those hardly farther; null: nothing is there.
function draw(list, eye, width, height) {
  const depth = new Float64Array(width * height).fill(Infinity), colours = new Array(width * height).fill(null);
  eachPixel(list, eye, width, height, (t, pixel, z) => { depth[pixel] = Math.min(depth[pixel], z); });
  eachPixel(list, eye, width, height, (t, pixel, z, weights) => {
    if (z > 1.002 * depth[pixel]) return;
    const value = t.values ? weights.reduce((sum, w, k) => sum + w * t.values[k], 0) : -1;
    (colours[pixel] = colours[pixel] || []).push(value >= 0 ? heat(Math.min(1, value)) : t.colour);
  });
  return colours;
}

// What is seen ----------------------------------------------------------------------------------

function decodePng(bytes) {
  let at = 8, width = 0, height = 0, channels = 0;
  const parts = [];
  while (at < bytes.length) {
    const length = bytes.readUInt32BE(at), kind = bytes.toString('latin1', at + 4, at + 8), body = bytes.subarray(at + 8, at + 8 + length);
    if (kind === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      channels = {2: 3, 6: 4}[body[9]];
      assert(body[8] === 8 && channels && body[12] === 0, 'a PNG with 8 bits of RGB');
    }
    if (kind === 'IDAT') parts.push(body);
    at += 12 + length;
  }
  const raw = zlib.inflateSync(Buffer.concat(parts)), row = width * channels, out = Buffer.alloc(row * height);
  for (let y = 0; y < height; ++y)
    for (let i = 0; i < row; ++i) {
      const a = i >= channels ? out[y * row + i - channels] : 0, b = y > 0 ? out[(y - 1) * row + i] : 0;
      const c = i >= channels && y > 0 ? out[(y - 1) * row + i - channels] : 0;
      const pa = Math.abs(b - c), pb = Math.abs(a - c), pc = Math.abs(a + b - 2 * c);
      const guess = [0, a, b, (a + b) >> 1, pa <= pb && pa <= pc ? a : pb <= pc ? b : c][raw[y * (row + 1)]];
      out[y * row + i] = raw[y * (row + 1) + 1 + i] + guess;
    }
  return {width, height, at: (pixel) => [0, 1, 2].map((k) => out[pixel * channels + k] / 255)};
}

for (const look of looks) {
  Object.assign(look, trianglesOf(look));
  assert(look.list.length > 0, `${look.word}: there is nothing to be seen`);
  look.eye = eyeFor(look.list);
  const {target, distance, yaw, pitch} = look.eye;
  const bare = look.fault === 'whole' ? [] : ['bare=1', 'edges=0', `view=${[...target, distance, yaw, pitch]}`];
  look.address = `file://${look.file}#${[...look.controls].map((c) => c.join('=')).concat(bare).join('&')}`;
}
const rows = Math.ceil(looks.length / kColumns), folder = path.dirname(path.resolve(picture));
fs.writeFileSync(path.join(folder, 'sheet.html'), '<!DOCTYPE html><meta charset="utf-8"><style>body { margin: 0 } iframe { position: absolute; border: 0 }</style>' +
  looks.map((l) => `<iframe src="${l.address.replace(/&/g, '&amp;')}" width="${kWidth}" height="${kHeight}" style="left: ${l.left}px; top: ${l.top}px"></iframe>`).join('\n'));
const profile = fs.mkdtempSync(path.join(folder, 'profile-'));
const ran = spawnSync(chromium, ['--headless', '--no-sandbox', '--disable-dev-shm-usage', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--hide-scrollbars', '--force-device-scale-factor=1',
  `--window-size=${kColumns * kWidth},${rows * kHeight}`, '--enable-logging=stderr', `--user-data-dir=${profile}`, '--no-first-run',
  '--disable-background-networking', '--host-resolver-rules=MAP * ~NOTFOUND', `--screenshot=${path.resolve(picture)}`,
  `file://${path.join(folder, 'sheet.html')}`], {encoding: 'utf8', timeout: 240000});
fs.rmSync(profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 200});
assert(ran.status === 0 && fs.existsSync(picture), `no picture: ${ran.status} ${ran.signal} ${ran.stderr.slice(-500)}`);
// That reading pixels waits for drawing is no news.
const said = ran.stderr.split('\n').filter((line) => line.includes('CONSOLE') && !line.includes('GPU stall'));
const seen = decodePng(fs.readFileSync(picture));
assert(seen.width >= kColumns * kWidth && seen.height >= rows * kHeight, `a picture of ${seen.width} x ${seen.height}`);

const background = [0.97, 0.975, 0.98];
const apart = (a, b) => Math.max(...a.map((x, k) => Math.abs(x - b[k])));
const pixelOf = (look, x, y) => seen.at((look.top + y) * seen.width + look.left + x);

/// Words on the left and something drawn on the right.
function faultOfWhole(look) {
  let dark = 0, drawn = 0;
  for (let y = 0; y < kHeight / 2; ++y)
    for (let x = 0; x < kWidth; ++x) {
      const rgb = pixelOf(look, x, y);
      if (x < kWidth / 3) dark += Math.max(...rgb) < 0.5 ? 1 : 0;
      else if (x > kWidth / 2) drawn += apart(rgb, background) > 0.1 ? 1 : 0;
    }
  console.log(`${path.basename(look.word)}: ${dark} dark pixels of words, ${drawn} drawn ones`);
  return dark < 100 ? 'words' : drawn < 500 ? 'blank' : 'whole';
}

/// Light changes how bright a colour is, not which.
function alike(a, b) {
  return a.reduce((s, x, k) => s + x * b[k], 0) > 0.985 * Math.hypot(...a) * Math.hypot(...b);
}

/// The eight pixels round one, those of the picture's border apart.
function around(pixel) {
  const x = pixel % kWidth, out = [];
  for (const dy of [-1, 0, 1])
    for (const dx of [-1, 0, 1])
      if (x + dx >= 0 && x + dx < kWidth) out.push(pixel + dy * kWidth + dx);
  return out.filter((other) => other !== pixel && other >= 0 && other < kWidth * kHeight);
}

/// What is wrong with a page; undefined: nothing.
function faultOf(look) {
  if (said.some((line) => line.includes(path.basename(look.file)))) return 'console';
  if (look.fault === 'whole') return faultOfWhole(look);
  const expected = draw(look.list, look.eye, kWidth, kHeight), kinds = new Set();
  let both = 0, either = 0, right = 0, wrong = 0;
  expected.forEach((colours, pixel) => {
    const rgb = pixelOf(look, pixel % kWidth, Math.floor(pixel / kWidth)), drawn = apart(rgb, background) > 0.02;
    both += drawn && colours ? 1 : 0;
    either += drawn || colours ? 1 : 0;
    if (!drawn || !colours) return;
    kinds.add(colours[0].map((x) => Math.round(4 * x)).join());
    // Where two colours meet, beside each other or as deep as each other, pixels are drawn in a mixture.
    if (![pixel, ...around(pixel)].every((other) => expected[other] && expected[other].every((c) => alike(c, colours[0])))) return;
    if (alike(colours[0], rgb)) ++right;
    else ++wrong;
  });
  console.log(`${path.basename(look.word)}: ${either} pixels drawn, ${(100 * both / either).toFixed(1)} % of them as expected, ` +
    `colours of ${right + wrong} ${(100 * right / (right + wrong)).toFixed(1)} %, ${kinds.size} kinds of them${look.opaque ? '' : ', blended'}`);
  if (either < 0.02 * kWidth * kHeight) return 'blank';
  if (both < 0.97 * either) return 'outline';
  if (look.opaque && (right < 0.97 * (right + wrong) || right + wrong < 0.5 * both)) return 'colours';
  const plain = look.controls.get('colours') === 'plain';
  return look.opaque && !plain && kinds.size < 2 ? 'colours' : undefined;
}

let bad = 0;
for (const look of looks) {
  const fault = faultOf(look);
  if (fault === look.fault) continue;
  ++bad;
  console.log(`FAILED: ${look.word}: ${fault || 'nothing'} is wrong instead of ${look.fault || 'nothing'}`);
}
for (const line of said.filter((l) => !looks.some((look) => look.fault === 'console' && l.includes(path.basename(look.file))))) {
  ++bad;
  console.log(`FAILED: on the console: ${line.slice(0, 300)}`);
}
process.exitCode = bad > 0 ? 1 : 0;

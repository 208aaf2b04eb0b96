// Draws what scene.js says, and moves through time. WebGL 1, nothing else.
'use strict';

(() => {
  const S = KaboumScene;
  const data = JSON.parse(document.getElementById('data').textContent);
  const $ = (id) => document.getElementById(id);
  const canvas = $('canvas');
  const gl = canvas.getContext('webgl', {alpha: false, antialias: true, preserveDrawingBuffer: true});

  // Pictures -----------------------------------------------------------------------------------

  const palette = [[0.36, 0.54, 0.77], [0.93, 0.6, 0.29], [0.45, 0.69, 0.42], [0.79, 0.43, 0.41], [0.61, 0.5, 0.74],
                   [0.66, 0.52, 0.42], [0.86, 0.55, 0.74], [0.55, 0.6, 0.35], [0.38, 0.7, 0.74]];
  const robotColours = [[0.68, 0.7, 0.73], [0.86, 0.72, 0.5], [0.62, 0.75, 0.66], [0.76, 0.66, 0.76]];

  function compile(vertex, fragment) {
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  // Each vertex: position, normal, middle of its body less that of the shape, number of its body.
  const kFloats = 10;
  const vertexText = `
    attribute vec3 position, normal, away;
    attribute float body;
    uniform mat4 camera, pose;
    uniform float explode;
    uniform vec3 colour;
    uniform bool byBody;
    uniform vec3 palette[9];
    varying vec3 n, c;
    void main() {
      gl_Position = camera * (pose * vec4(position + explode * away, 1.0));
      n = mat3(pose[0].xyz, pose[1].xyz, pose[2].xyz) * normal;
      c = colour;
      if (byBody) for (int i = 0; i < 9; ++i) if (abs(mod(body, 9.0) - float(i)) < 0.5) c = palette[i];
    }`;
  const fragmentText = `
    precision mediump float;
    varying vec3 n, c;
    uniform vec3 light;
    uniform float alpha;
    uniform bool flatColour;
    void main() {
      float d = abs(dot(normalize(n), light)) * 0.55 + 0.3 + 0.15 * normalize(n).z;
      gl_FragColor = vec4(flatColour ? c : c * d, alpha);
    }`;

  const middle = (points) => {
    const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    points.forEach((x, i) => { low[i % 3] = Math.min(low[i % 3], x); high[i % 3] = Math.max(high[i % 3], x); });
    return low.map((x, i) => (x + high[i]) / 2);
  };
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const minus = (a, b) => a.map((x, i) => x - b[i]);
  const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
  const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };

  /// Buffers of triangles, and of the edges that are no flat ones, of several bodies.
  function upload(bodies, first) {
    const decoded = bodies.map((b) => ({points: S.decode(b.points, Float32Array), triangles: S.decode(b.triangles, Uint32Array)}));
    const centers = decoded.map((b) => middle(b.points));
    const all = middle(centers.flat());
    const faces = [], lines = [];
    decoded.forEach(({points, triangles}, body) => {
      const away = minus(centers[body], all);
      const corner = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
      const edges = new Map();
      for (let t = 0; t < triangles.length; t += 3) {
        const at = [0, 1, 2].map((k) => triangles[t + k]), p = at.map(corner);
        const normal = unit(cross(minus(p[1], p[0]), minus(p[2], p[0])));
        p.forEach((x) => faces.push(...x, ...normal, ...away, first + body));
        at.forEach((a, k) => {
          const b = at[(k + 1) % 3], key = a < b ? a + ' ' + b : b + ' ' + a, other = edges.get(key);
          if (other) other.sharp = dot(other.normal, normal) < 0.9;
          else edges.set(key, {a, b, normal, sharp: true});
        });
      }
      for (const {a, b, normal, sharp} of edges.values())
        if (sharp) for (const v of [a, b]) lines.push(...corner(v), ...normal, ...away, first + body);
    });
    const buffer = (values) => {
      const id = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, id);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
      return {id, count: values.length / kFloats};
    };
    const low = [0, 1, 2].map((k) => Math.min(...decoded.map((b) => b.points.reduce((m, x, i) => i % 3 === k ? Math.min(m, x) : m, Infinity))));
    const high = [0, 1, 2].map((k) => Math.max(...decoded.map((b) => b.points.reduce((m, x, i) => i % 3 === k ? Math.max(m, x) : m, -Infinity))));
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => [0, 1, 2].map((k) => c >> k & 1 ? high[k] : low[k]));
    return {faces: buffer(faces), lines: buffer(lines), corners};
  }

  let program, where;
  const drawn = [];
  if (gl) {
    program = compile(vertexText, fragmentText);
    where = (name) => gl.getUniformLocation(program, name);
    for (const shape of data.shapes)
      drawn.push({shape, sets: shape.bodies ? upload(shape.bodies, drawn.length) : null, exact: shape.exact ? upload([shape.exact], 0) : null,
                  colour: shape.robot !== undefined ? robotColours[shape.robot % robotColours.length] : palette[shape.object % palette.length]});
  } else {
    $('message').textContent = 'This browser has no WebGL: the scene cannot be drawn.';
  }
  for (const what of ['sets', 'exact'])
    if (gl && !drawn.some((d) => d[what])) {
      $('shapes').querySelector(`[value=${what}]`).disabled = $('shapes').querySelector('[value=both]').disabled = true;
      $('shapes').value = what === 'sets' ? 'exact' : 'sets';
    }

  // Camera -------------------------------------------------------------------------------------

  const eye = {target: [0, 0, 0], distance: 3, yaw: -0.9, pitch: 0.45};
  (function frame() {
    const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    const size = () => Math.hypot(...minus(high, low));
    const robotsFirst = [...drawn].sort((a, b) => (a.shape.robot === undefined) - (b.shape.robot === undefined));
    let robots = 0;
    for (const d of robotsFirst) {
      const pose = S.shapePose(data, data.states[0], d.shape), {corners} = d.sets || d.exact || {corners: []};
      if (!pose || corners.length === 0) continue;
      if (d.shape.robot !== undefined) robots = 0;
      else if (robots === 0) robots = low[0] < high[0] ? size() : Infinity;
      // Grounds and walls would hide how large the rest is.
      if (Math.hypot(...minus(corners[7], corners[0])) > 2 * (robots || Infinity)) continue;
      for (const corner of corners)
        for (let i = 0; i < 3; ++i) {
          const x = pose[9 + i] + dot(pose.slice(3 * i, 3 * i + 3), corner);
          low[i] = Math.min(low[i], x);
          high[i] = Math.max(high[i], x);
        }
    }
    if (!(low[0] < high[0])) return;
    eye.target = low.map((x, i) => (x + high[i]) / 2);
    eye.distance = 1.7 * size();  // what is nearer than the middle looks larger
  })();

  function cameraMatrix(width, height) {
    const back = [Math.cos(eye.pitch) * Math.cos(eye.yaw), Math.cos(eye.pitch) * Math.sin(eye.yaw), Math.sin(eye.pitch)];
    const right = [-Math.sin(eye.yaw), Math.cos(eye.yaw), 0], up = cross(back, right);
    const from = eye.target.map((x, i) => x + eye.distance * back[i]);
    const near = eye.distance / 100, far = eye.distance * 20, f = 1 / Math.tan(0.35);
    const rows = [right, up, back].map((r) => [...r, -dot(r, from)]);
    const a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    const m = [rows[0].map((x) => x * f * height / width), rows[1].map((x) => x * f),
               rows[2].map((x, i) => a * x + (i === 3 ? b : 0)), rows[2].map((x) => -x)];
    return {matrix: [0, 1, 2, 3].flatMap((c) => m.map((row) => row[c])), back, right, up};
  }

  const matrixOf = (p) => [p[0], p[3], p[6], 0, p[1], p[4], p[7], 0, p[2], p[5], p[8], 0, p[9], p[10], p[11], 1];

  function drawPart(part, mode) {
    gl.bindBuffer(gl.ARRAY_BUFFER, part.id);
    let offset = 0;
    for (const [name, size] of [['position', 3], ['normal', 3], ['away', 3], ['body', 1]]) {
      const at = gl.getAttribLocation(program, name);
      if (at >= 0) {
        gl.enableVertexAttribArray(at);
        gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * kFloats, 4 * offset);
      }
      offset += size;
    }
    gl.drawArrays(mode, 0, part.count);
  }

  function drawState(state, kind, alpha, only) {
    const links = data.robots.map((robot, r) => S.forward(robot, state.q[r]));
    gl.uniform1f(where('alpha'), alpha);
    for (const d of drawn) {
      if (only && !only(d.shape)) continue;
      if (!$(d.shape.robot !== undefined ? 'robots' : 'objects').checked) continue;
      const buffers = d[kind] || d.sets || d.exact, pose = S.shapePose(data, state, d.shape, links);
      if (!pose || !buffers) continue;
      gl.uniformMatrix4fv(where('pose'), false, matrixOf(pose));
      gl.uniform3fv(where('colour'), d.colour);
      gl.uniform1i(where('byBody'), $('bodies').checked && buffers === d.sets);
      gl.uniform1i(where('flatColour'), 0);
      drawPart(buffers.faces, gl.TRIANGLES);
      if (!$('edges').checked || alpha < 0.3) continue;
      gl.uniform1i(where('byBody'), 0);
      gl.uniform1i(where('flatColour'), 1);
      gl.uniform3fv(where('colour'), d.colour.map((x) => 0.45 * x));
      drawPart(buffers.lines, gl.LINES);
    }
  }

  const kTraces = 12;

  function draw() {
    if (!gl) return;
    const scale = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0.97, 0.975, 0.98, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.useProgram(program);
    const camera = cameraMatrix(canvas.width, canvas.height);
    gl.uniformMatrix4fv(where('camera'), false, camera.matrix);
    gl.uniform3fv(where('light'), unit(camera.back.map((x, i) => x + 0.4 * camera.up[i] + 0.3 * camera.right[i])));
    gl.uniform3fv(where('palette'), palette.flat());
    gl.uniform1f(where('explode'), Number($('explode').value));
    const now = S.at(data, played, time), kind = $('shapes').value;
    gl.disable(gl.BLEND);
    drawState(now.state, kind === 'both' ? 'exact' : kind, 1);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    if (kind === 'both') drawState(now.state, 'sets', 0.35, (shape) => shape.exact);
    const step = played.steps[now.index];
    if ($('trace').checked && step && step.parts.length > 0)
      for (let k = 0; k < kTraces; ++k) {
        const then = step.begin + (step.end - step.begin) * k / kTraces;
        const moving = step.parts.filter((p) => p.begin <= then).pop().motion;
        drawState(S.at(data, played, then).state, kind, 0.12, (shape) => shape.robot === moving.robot ||
          (shape.object !== undefined && moving.holds[shape.object] !== undefined));
      }
    gl.depthMask(true);
  }

  // Time ---------------------------------------------------------------------------------------

  let choices = [], played = S.branch(data, choices), time = 0, playing = false, before = 0, shown = -2;

  function listSteps() {
    $('steps').replaceChildren(...played.steps.map((step, index) => {
      const item = document.createElement('li'), {ways, node} = data.steps[step.number];
      item.textContent = data.nodes[node].action || '(looks)';
      const small = document.createElement('small');
      small.textContent = `  ${step.begin.toFixed(1)} s`;
      item.append(small);
      if (ways.some((way) => way.outcome)) {
        const select = document.createElement('select');
        ways.forEach((way, k) => select.add(new Option(way.outcome || 'goes on', k, false, k === step.way)));
        select.onclick = (event) => event.stopPropagation();
        select.onchange = () => {
          choices = played.steps.slice(0, index).map((s) => s.way);
          choices.push(Number(select.value));
          choose(step.begin);
        };
        item.append(select);
      }
      item.onclick = () => show(step.begin);
      return item;
    }));
    const end = document.createElement('li');
    end.textContent = 'goal';
    end.onclick = () => show(played.duration);
    $('steps').append(end);
    $('time').max = played.duration;
  }

  function choose(at) {
    played = S.branch(data, choices);
    listSteps();
    shown = -2;
    show(at);
  }

  function show(at) {
    time = Math.max(0, Math.min(at, played.duration));
    $('time').value = time;
    $('clock').textContent = `${time.toFixed(2)} of ${played.duration.toFixed(2)} s`;
    const over = time >= played.duration, index = over ? played.steps.length : S.at(data, played, time).index;
    if (index !== shown) {
      shown = index;
      [...$('steps').children].forEach((item, k) => item.classList.toggle('now', k === index));
      const item = $('steps').children[index];
      if (item && item.scrollIntoView) item.scrollIntoView({block: 'nearest'});
      const node = index < played.steps.length ? data.steps[played.steps[index].number].node : -1;
      document.querySelectorAll('#graph [id^="node-"]').forEach((box) => box.classList.toggle('now', box.id === 'node-' + node));
      if (gl) $('message').textContent = index < 0 || played.steps.length === 0 ? '' : over ? 'goal' : data.nodes[node].action;
    }
    draw();
  }

  function tick(now) {
    if (!playing) return;
    show(time + (now - before) / 1000 * Number($('speed').value));
    before = now;
    if (time >= played.duration) play(false);
    else requestAnimationFrame(tick);
  }

  function play(on) {
    playing = on;
    $('play').textContent = on ? 'pause' : 'play';
    if (!on) return;
    if (time >= played.duration) show(0);
    before = performance.now();
    requestAnimationFrame(tick);
  }

  $('play').onclick = () => play(!playing);
  $('time').oninput = () => { play(false); show(Number($('time').value)); };
  for (const id of ['shapes', 'robots', 'objects', 'bodies', 'edges', 'trace', 'explode']) $(id).oninput = draw;
  for (const radio of document.querySelectorAll('[name=list]'))
    radio.onchange = () => { $('steps').hidden = radio.value !== 'steps'; $('graph').hidden = radio.value !== 'graph'; };
  document.querySelectorAll('#graph [id^="node-"]').forEach((box) => {
    box.onclick = () => {
      const to = S.choicesTo(data, (step) => 'node-' + step.node === box.id);
      if (!to) return;
      choices = to;
      choose(0);
      show(played.steps[to.length].begin);
    };
  });
  document.onkeydown = (event) => {
    if (['INPUT', 'SELECT', 'BUTTON'].includes(event.target.tagName)) return;
    if (event.key === ' ') { event.preventDefault(); play(!playing); }
    if (event.key === 'ArrowRight') show(time + 0.1);
    if (event.key === 'ArrowLeft') show(time - 0.1);
  };
  canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
  canvas.onpointermove = (event) => {
    if (event.buttons === 0) return;
    if (event.buttons & 1 && !event.shiftKey) {
      eye.yaw -= event.movementX * 0.008;
      eye.pitch = Math.max(-1.5, Math.min(1.5, eye.pitch + event.movementY * 0.008));
    } else {
      const camera = cameraMatrix(canvas.width, canvas.height), step = 0.73 * eye.distance / canvas.clientHeight;
      eye.target = eye.target.map((x, i) => x - step * (event.movementX * camera.right[i] - event.movementY * camera.up[i]));
    }
    draw();
  };
  canvas.oncontextmenu = (event) => event.preventDefault();
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    eye.distance *= Math.exp(event.deltaY * 0.001);
    draw();
  }, {passive: false});
  window.onresize = draw;

  // #t=12.5 begins there: for pictures of a page.
  const wanted = /t=([0-9.]+)/.exec(location.hash);
  if (played.steps.length === 0) document.body.classList.add('still');
  choose(wanted ? Number(wanted[1]) : 0);
})();

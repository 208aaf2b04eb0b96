// Draws triangles and their edges, and lets one walk round them. WebGL 1, nothing else.
'use strict';

const KaboumView = (() => {
  const palette = [[0.36, 0.54, 0.77], [0.93, 0.6, 0.29], [0.45, 0.69, 0.42], [0.79, 0.43, 0.41], [0.61, 0.5, 0.74],
                   [0.66, 0.52, 0.42], [0.86, 0.55, 0.74], [0.55, 0.6, 0.35], [0.38, 0.7, 0.74]];
  // The colour map "viridis" (S. van der Walt, N. Smith, 2015; CC0), every eighth of the way.
  const heat = [[0.267, 0.005, 0.329], [0.279, 0.175, 0.483], [0.230, 0.322, 0.546], [0.173, 0.449, 0.558],
                [0.128, 0.567, 0.551], [0.158, 0.684, 0.502], [0.369, 0.789, 0.383], [0.678, 0.864, 0.190],
                [0.993, 0.906, 0.144]];
  const background = [0.97, 0.975, 0.98];

  // Each vertex: position, normal, middle of its body less that of all, number of its body, value.
  const kParts = [['position', 3], ['normal', 3], ['away', 3], ['body', 1], ['value', 1]];
  const kFloats = 11;
  const vertexText = `
    attribute vec3 position, normal, away;
    attribute float body, value;
    uniform mat4 camera, pose;
    uniform float explode;
    uniform vec3 colour;
    uniform bool byBody;
    uniform vec3 palette[9];
    varying vec3 n, c;
    varying float v;
    void main() {
      gl_Position = camera * (pose * vec4(position + explode * away, 1.0));
      n = mat3(pose[0].xyz, pose[1].xyz, pose[2].xyz) * normal;
      v = value;
      c = colour;
      if (byBody) for (int i = 0; i < 9; ++i) if (abs(mod(body, 9.0) - float(i)) < 0.5) c = palette[i];
    }`;
  const fragmentText = `
    precision mediump float;
    varying vec3 n, c;
    varying float v;
    uniform vec3 light, heat[9];
    uniform float alpha;
    uniform bool flatColour, byValue;
    void main() {
      vec3 k = c;
      if (byValue && v >= 0.0) {
        k = heat[0];
        for (int i = 0; i < 8; ++i) k = mix(k, heat[i + 1], clamp(8.0 * v - float(i), 0.0, 1.0));
      }
      float d = abs(dot(normalize(n), light)) * 0.55 + 0.3 + 0.15 * normalize(n).z;
      if (byValue) d = 0.4 + 0.6 * d;
      gl_FragColor = vec4(flatColour ? k : k * d, alpha);
    }`;

  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const minus = (a, b) => a.map((x, i) => x - b[i]);
  const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
  const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };

  function boxOf(points) {
    const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    for (let i = 0; i < points.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
    return {low, high};
  }
  const middle = ({low, high}) => low.map((x, i) => (x + high[i]) / 2);

  /// Sharp edges of triangles: of one triangle, of more than two, or with an angle whose cosine is less
  /// than `flat`. Calls visit(corner, corner, number of a triangle).
  function eachEdge(triangles, corners, normals, flat, visit) {
    const first = new Map();  // edge -> a corner that begins it; negative: it is no sharp one
    for (let i = 0; i < triangles.length; ++i) {
      const a = triangles[i], b = triangles[i % 3 === 2 ? i - 2 : i + 1];
      const key = Math.min(a, b) * corners + Math.max(a, b), other = first.get(key);
      if (other === undefined) {
        first.set(key, i);
        continue;
      }
      const s = 3 * Math.floor((other < 0 ? -other - 1 : other) / 3), t = 3 * Math.floor(i / 3);
      const same = normals[s] * normals[t] + normals[s + 1] * normals[t + 1] + normals[s + 2] * normals[t + 2];
      if (other >= 0 && same >= flat) first.set(key, -other - 1);
    }
    for (const i of first.values())
      if (i >= 0) visit(triangles[i], triangles[i % 3 === 2 ? i - 2 : i + 1], Math.floor(i / 3));
  }

  /// Bodies {points, triangles, values or none} as vertices of triangles and of edges, and the corners of
  /// their box. @param first  number of the first body.
  function arrangement(bodies, first, flat) {
    const boxes = bodies.map((b) => boxOf(b.points)), all = middle(boxOf(boxes.flatMap(middle)));
    const faces = new Float32Array(kFloats * bodies.reduce((sum, b) => sum + b.triangles.length, 0)), lines = [];
    let at = 0;
    bodies.forEach(({points, triangles, values}, body) => {
      const away = minus(middle(boxes[body]), all), normals = new Float32Array(triangles.length);
      const corner = (i) => [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
      for (let t = 0; t < triangles.length; t += 3) {
        const p = [0, 1, 2].map((k) => corner(triangles[t + k]));
        const normal = unit(cross(minus(p[1], p[0]), minus(p[2], p[0])));
        normals.set(normal, t);
        p.forEach((x, k) => {
          faces.set([...x, ...normal, ...away, first + body, values ? values[triangles[t + k]] : -1], at);
          at += kFloats;
        });
      }
      eachEdge(triangles, points.length / 3, normals, flat, (a, b, t) => {
        for (const c of [a, b]) lines.push(...corner(c), ...normals.subarray(3 * t, 3 * t + 3), ...away, first + body, -1);
      });
    });
    const low = [0, 1, 2].map((k) => Math.min(...boxes.map((b) => b.low[k])));
    const high = [0, 1, 2].map((k) => Math.max(...boxes.map((b) => b.high[k])));
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => [0, 1, 2].map((k) => c >> k & 1 ? high[k] : low[k]));
    return {faces, lines: new Float32Array(lines), corners};
  }

  function compile(gl) {
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return program;
  }

  function cameraOf(eye, width, height) {
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

  /// What the part of the page's address after # says, "t=12.5&edges=0": a control by its id, or others.
  const wanted = () => new Map(location.hash.slice(1).split('&').filter((x) => x.includes('=')).map((x) => x.split('=')));

  /// Sets the controls that the address names.
  function setWanted() {
    for (const [id, value] of wanted()) {
      const control = document.getElementById(id);
      if (control && control.type === 'checkbox') control.checked = value !== '0';
      else if (control && 'value' in control) control.value = value;
    }
    document.body.classList.toggle('bare', wanted().get('bare') === '1');
  }

  /// What draws on a canvas, and follows the pointer; null where there is no WebGL.
  /// redraw() is called after the eye has moved.
  function create(canvas, redraw) {
    const gl = canvas.getContext('webgl', {alpha: false, antialias: true, preserveDrawingBuffer: true});
    if (!gl) return null;
    const program = compile(gl), places = new Map(), eye = {target: [0, 0, 0], distance: 3, yaw: -0.9, pitch: 0.45};
    const where = (name) => {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
      return places.get(name);
    };
    const flag = (name, value) => gl.uniform1i(where(name), value ? 1 : 0);

    function buffer(values) {
      const id = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, id);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      return {id, count: values.length / kFloats};
    }

    /// Buffers of bodies. @param flat  cosine from which on an edge is not drawn.
    function upload(bodies, first, flat = 0.9) {
      const {faces, lines, corners} = arrangement(bodies, first, flat);
      return {faces: buffer(faces), lines: buffer(lines), corners};
    }

    function drawPart(part, mode) {
      gl.bindBuffer(gl.ARRAY_BUFFER, part.id);
      let offset = 0;
      for (const [name, size] of kParts) {
        const at = gl.getAttribLocation(program, name);
        if (at >= 0) {
          gl.enableVertexAttribArray(at);
          gl.vertexAttribPointer(at, size, gl.FLOAT, false, 4 * kFloats, 4 * offset);
        }
        offset += size;
      }
      gl.drawArrays(mode, 0, part.count);
    }

    function begin(palettes) {
      const scale = window.devicePixelRatio || 1;
      canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
      canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(...background, 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.depthFunc(gl.LEQUAL);
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
      gl.useProgram(program);
      const camera = cameraOf(eye, canvas.width, canvas.height);
      gl.uniformMatrix4fv(where('camera'), false, camera.matrix);
      gl.uniform3fv(where('light'), unit(camera.back.map((x, i) => x + 0.4 * camera.up[i] + 0.3 * camera.right[i])));
      gl.uniform3fv(where('palette'), palettes.flat());
      gl.uniform3fv(where('heat'), heat.flat());
    }

    function drawItem(item, colours) {
      gl.uniform1f(where('alpha'), item.alpha);
      gl.uniform1f(where('explode'), item.explode || 0);
      gl.uniformMatrix4fv(where('pose'), false, matrixOf(item.pose));
      gl.uniform3fv(where('colour'), item.colour);
      flag('byBody', item.paint === 'body');
      flag('byValue', item.paint === 'value');
      flag('flatColour', false);
      gl.colorMask(colours, colours, colours, colours);
      drawPart(item.buffers.faces, gl.TRIANGLES);
      if (!item.edges || !colours) return;
      flag('byBody', false);
      flag('byValue', false);
      flag('flatColour', true);
      gl.uniform3fv(where('colour'), item.colour.map((x) => 0.45 * x));
      drawPart(item.buffers.lines, gl.LINES);
    }

    /// Draws items {buffers, pose, colour, alpha, explode, paint, edges, glass}: the opaque ones, then those
    /// with alpha below 1, of which items of the same `glass` show only what is nearest.
    function draw(items) {
      begin(palette);
      gl.disable(gl.BLEND);
      for (const item of items) if (item.alpha >= 1) drawItem(item, true);
      gl.enable(gl.BLEND);
      gl.depthMask(false);
      for (const item of items) if (item.alpha < 1 && item.glass === undefined) drawItem(item, true);
      gl.depthMask(true);
      for (const glass of new Set(items.filter((i) => i.alpha < 1 && i.glass !== undefined).map((i) => i.glass))) {
        const sheet = items.filter((i) => i.alpha < 1 && i.glass === glass);
        for (const item of sheet) drawItem(item, false);
        for (const item of sheet) drawItem(item, true);
      }
    }

    /// Looks at boxes {corners, pose} from so far that all of them is seen. @return whether there are any.
    function frame(boxes) {
      const points = boxes.flatMap(({corners, pose}) => corners.map((corner) =>
        [0, 1, 2].map((i) => pose[9 + i] + dot(pose.slice(3 * i, 3 * i + 3), corner))));
      if (points.length === 0) return false;
      const box = boxOf(points.flat());
      eye.target = middle(box);
      eye.distance = 1.7 * Math.hypot(...minus(box.high, box.low)) || 1;  // what is nearer than the middle looks larger
      return true;
    }

    /// Where the address says: view=x,y,z,distance,yaw,pitch.
    function place() {
      const numbers = (wanted().get('view') || '').split(',').map(Number);
      if (numbers.length !== 6 || !numbers.every(Number.isFinite)) return;
      eye.target = numbers.slice(0, 3);
      [eye.distance, eye.yaw, eye.pitch] = numbers.slice(3);
    }

    canvas.onpointerdown = (event) => canvas.setPointerCapture(event.pointerId);
    canvas.onpointermove = (event) => {
      if (event.buttons === 0) return;
      if (event.buttons & 1 && !event.shiftKey) {
        eye.yaw -= event.movementX * 0.008;
        eye.pitch = Math.max(-1.5, Math.min(1.5, eye.pitch + event.movementY * 0.008));
      } else {
        const camera = cameraOf(eye, canvas.width, canvas.height), step = 0.73 * eye.distance / canvas.clientHeight;
        eye.target = eye.target.map((x, i) => x - step * (event.movementX * camera.right[i] - event.movementY * camera.up[i]));
      }
      redraw();
    };
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      eye.distance *= Math.exp(event.deltaY * 0.001);
      redraw();
    }, {passive: false});
    window.addEventListener('resize', redraw);
    return {upload, draw, frame, place};
  }

  return {palette, heat, create, setWanted, wanted, arrangement, minus};
})();

if (typeof module !== 'undefined') module.exports = KaboumView;

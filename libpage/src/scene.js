// Where everything is at a time of a plan's execution. No drawing: also run by the tests.
'use strict';

const KaboumScene = (() => {
  // A pose is 12 numbers: a rotation row by row, then a translation.
  const identity = [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0];

  function multiply(a, b) {
    const out = new Array(12);
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j)
        out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
      out[9 + i] = a[3 * i] * b[9] + a[3 * i + 1] * b[10] + a[3 * i + 2] * b[11] + a[9 + i];
    }
    return out;
  }

  function inverse(a) {
    const out = new Array(12);
    for (let i = 0; i < 3; ++i) {
      for (let j = 0; j < 3; ++j) out[3 * i + j] = a[3 * j + i];
      out[9 + i] = -(a[i] * a[9] + a[3 + i] * a[10] + a[6 + i] * a[11]);
    }
    return out;
  }

  function turn([x, y, z], angle) {
    const c = Math.cos(angle), s = Math.sin(angle), k = 1 - c;
    return [c + k * x * x, k * x * y - s * z, k * x * z + s * y,
            k * x * y + s * z, c + k * y * y, k * y * z - s * x,
            k * x * z - s * y, k * y * z + s * x, c + k * z * z, 0, 0, 0];
  }

  /// Poses of all links of a robot in the world.
  function forward(robot, q) {
    const poses = [robot.base];
    robot.joints.forEach((joint, j) => {
      let local = joint.origin;
      if (joint.type !== 'fixed') {
        const value = joint.multiplier * q[joint.variable] + joint.offset;
        const shift = [1, 0, 0, 0, 1, 0, 0, 0, 1, ...joint.axis.map((x) => x * value)];
        local = multiply(local, joint.type === 'revolute' ? turn(joint.axis, value) : shift);
      }
      poses[j + 1] = multiply(poses[joint.parent], local);
    });
    return poses;
  }

  /// A value of a joint in words: degrees, or mm.
  function valueText({slides}, value) {
    return slides ? `${Number((1000 * value).toPrecision(4))} mm` : `${Number((value * 180 / Math.PI).toPrecision(4))}°`;
  }

  /// The pose of an object, null when it has left.
  function objectPose(data, state, object) {
    const place = state.places[object];
    if (place.away) return null;
    if (place.robot === undefined) return place.pose;
    return multiply(forward(data.robots[place.robot], state.q[place.robot])[place.link], place.pose);
  }

  /// What a motion takes and lets go before it begins.
  function hold(data, state, motion) {
    const next = {q: state.q, places: state.places.slice()};
    const links = forward(data.robots[motion.robot], state.q[motion.robot]);
    state.places.forEach((place, object) => {
      if (place.away) return;
      const wanted = motion.holds[object];
      const held = place.robot === motion.robot;
      if (held && place.link === wanted) return;
      if (!held && wanted === undefined) return;
      const pose = objectPose(data, state, object);
      next.places[object] = wanted === undefined ? {pose}
        : {robot: motion.robot, link: wanted, pose: multiply(inverse(links[wanted]), pose)};
    });
    return next;
  }

  const share = (u) => u * u * u * (10 + u * (6 * u - 15));  // from rest to rest, twice differentiable

  /// Joint values at a time since the motion began.
  function along(motion, time) {
    const {times, path} = motion;
    if (time <= 0) return path[0];
    let k = 0;
    while (k + 1 < times.length && times[k + 1] <= time) ++k;
    if (k + 1 >= times.length) return path[path.length - 1];
    const s = share((time - times[k]) / (times[k + 1] - times[k]));
    return path[k].map((x, j) => x + s * (path[k + 1][j] - x));
  }

  /// Joint values at a share of a path of waypoints, each leg taking as long as its largest change of a joint.
  function pathAt(path, part) {
    if (part >= 1) return path[path.length - 1];
    const legs = path.slice(1).map((q, i) => Math.max(...q.map((x, j) => Math.abs(x - path[i][j]))));
    let left = part * legs.reduce((sum, x) => sum + x, 0);
    for (let i = 0; i < legs.length; left -= legs[i++])
      if (left < legs[i]) return path[i].map((x, j) => x + (path[i + 1][j] - x) * left / legs[i]);
    return path[path.length - 1];
  }

  /// Steps that have no motion are shown for so long. [s]
  const kPause = 0.5;

  /// The branch that is reached by choosing the ways `choices[i]` at the i-th step, the first one
  /// where there is no choice: steps with the time at which each begins and how it goes on.
  function branch(data, choices) {
    const steps = [];
    let time = 0;
    for (let number = data.root; number !== null && number !== undefined;) {
      const step = data.steps[number];
      const motions = data.nodes[step.node].motions;
      const way = Math.min(choices[steps.length] || 0, step.ways.length - 1);
      const parts = [];
      const begin = time;
      let state = data.states[step.before];
      for (const motion of motions) {
        state = hold(data, state, motion);
        parts.push({begin: time, motion, state});
        time += motion.times[motion.times.length - 1];
        const q = state.q.slice();
        q[motion.robot] = motion.path[motion.path.length - 1];
        state = {q, places: state.places};
      }
      if (parts.length === 0) time += kPause;
      steps.push({number, begin, end: time, parts, way, last: state});
      number = step.ways[way].next;
    }
    return {steps, duration: time};
  }

  /// The state at a time of a branch, and the number of the step that is carried out then.
  function at(data, played, time) {
    const {steps} = played;
    if (steps.length === 0) return {index: -1, state: data.states[0]};
    let index = 0;
    while (index + 1 < steps.length && steps[index + 1].begin <= time) ++index;
    const step = steps[index];
    if (time >= step.end) return {index, state: data.states[data.steps[step.number].ways[step.way].after]};
    if (step.parts.length === 0) return {index, state: data.states[data.steps[step.number].before]};
    let k = 0;
    while (k + 1 < step.parts.length && step.parts[k + 1].begin <= time) ++k;
    const part = step.parts[k];
    const q = part.state.q.slice();
    q[part.motion.robot] = along(part.motion, time - part.begin);
    return {index, state: {q, places: part.state.places}};
  }

  /// How far a played step ends from where the plan says that it does: the largest difference of a
  /// pose of an object that is still there.
  function gap(data, step) {
    const stated = data.states[data.steps[step.number].ways[step.way].after];
    let largest = 0;
    stated.places.forEach((place, object) => {
      const is = objectPose(data, step.last, object), should = objectPose(data, stated, object);
      if (!should) return;
      if (!is) largest = Infinity;
      else should.forEach((x, i) => { largest = Math.max(largest, Math.abs(x - is[i])); });
    });
    stated.q.forEach((q, robot) => q.forEach((x, i) => {
      largest = Math.max(largest, Math.abs(x - step.last.q[robot][i]));
    }));
    return largest;
  }

  /// The pose of a shape in a state; null: it is not there.
  function shapePose(data, state, shape, links) {
    if (shape.object !== undefined) return objectPose(data, state, shape.object);
    return (links ? links[shape.robot] : forward(data.robots[shape.robot], state.q[shape.robot]))[shape.link];
  }

  /// Choices that lead to a step, by the shortest way; null when none does.
  function choicesTo(data, wanted) {
    const from = new Map([[data.root, []]]);
    const todo = [data.root];
    while (todo.length > 0) {
      const number = todo.shift();
      if (wanted(data.steps[number])) return from.get(number);
      data.steps[number].ways.forEach((way, k) => {
        if (way.next === null || from.has(way.next)) return;
        from.set(way.next, [...from.get(number), k]);
        todo.push(way.next);
      });
    }
    return null;
  }

  function decode(text, Type) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Type(bytes.buffer);
  }

  /// A body or mesh of the page's data, with its numbers.
  const mesh = ({points, triangles, values}) => ({points: decode(points, Float32Array), triangles: decode(triangles, Uint32Array),
                                                  values: values ? decode(values, Float32Array) : null});

  return {identity, multiply, inverse, forward, valueText, objectPose, branch, at, gap, shapePose, choicesTo, decode, mesh, pathAt};
})();

if (typeof module !== 'undefined') module.exports = KaboumScene;

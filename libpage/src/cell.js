// A cell's robots and objects as view.js draws them, with the controls of a page that say how.
'use strict';

/// @param data  `robots` and `shapes` of a page; @param view  of KaboumView.create, or null
function KaboumCell(data, view) {
  const S = KaboumScene, V = KaboumView;
  const $ = (id) => document.getElementById(id);
  const robotColours = [[0.68, 0.7, 0.73], [0.86, 0.72, 0.5], [0.62, 0.75, 0.66], [0.76, 0.66, 0.76]];
  const isRobots = (shape) => shape.robot !== undefined;
  const drawn = [];
  if (view) {
    for (const shape of data.shapes)
      drawn.push({shape, sets: shape.bodies ? view.upload(shape.bodies.map(S.mesh), drawn.length) : null,
                  exact: shape.exact ? view.upload([S.mesh(shape.exact)], 0) : null,
                  colour: isRobots(shape) ? robotColours[shape.robot % robotColours.length] : V.palette[shape.object % V.palette.length]});
  } else {
    $('message').textContent = 'This browser has no WebGL: the scene cannot be drawn.';
  }
  for (const what of ['sets', 'exact'])
    if (view && !drawn.some((d) => d[what])) {
      $('shapes').querySelector(`[value=${what}]`).disabled = $('shapes').querySelector('[value=both]').disabled = true;
      $('shapes').value = what === 'sets' ? 'exact' : 'sets';
    }

  /// What is to be in view at the beginning: robots, and what does not dwarf them.
  function boxes() {
    const placed = drawn.map((d) => ({...(d.sets || d.exact || {corners: []}), pose: S.shapePose(data, data.states[0], d.shape), shape: d.shape}))
      .filter((b) => b.pose && b.corners.length > 0);
    const size = (b) => Math.hypot(...V.minus(b.corners[7], b.corners[0]));
    const robots = placed.filter((b) => isRobots(b.shape));
    const span = (of) => {  // of the middles, and the largest
      const at = of.map((b) => b.pose.slice(9)), wide = [0, 1, 2].map((i) => Math.max(...at.map((p) => p[i])) - Math.min(...at.map((p) => p[i])));
      return Math.hypot(...wide) + Math.max(...of.map(size));
    };
    // Grounds and walls would hide how large the rest is.
    const most = robots.length > 0 ? 2 * span(robots) : Infinity;
    return placed.filter((b) => isRobots(b.shape) || size(b) <= most);
  }

  /// Adds what is drawn of a state.
  function addState(items, state, kind, alpha, only) {
    const links = data.robots.map((robot, r) => S.forward(robot, state.q[r]));
    for (const d of drawn) {
      if (only && !only(d.shape)) continue;
      if (!$(isRobots(d.shape) ? 'robots' : 'objects').checked) continue;
      const buffers = d[kind] || d.sets || d.exact, pose = S.shapePose(data, state, d.shape, links);
      if (!pose || !buffers) continue;
      items.push({buffers, pose, colour: d.colour, alpha, explode: Number($('explode').value),
                  paint: $('bodies').checked && buffers === d.sets ? 'body' : 'colour', edges: $('edges').checked && alpha >= 0.3});
    }
  }

  /// The state as the controls say.
  function items(state) {
    const out = [], kind = $('shapes').value;
    addState(out, state, kind === 'both' ? 'exact' : kind, 1);
    if (kind === 'both') addState(out, state, 'sets', 0.35, (shape) => shape.exact);
    return out;
  }

  return {boxes, addState, items};
}

// Has view.js draw what scene.js says, and moves through time.
'use strict';

(() => {
  const S = KaboumScene, V = KaboumView;
  const data = JSON.parse(document.getElementById('data').textContent);
  const $ = (id) => document.getElementById(id);
  const canvas = $('canvas');
  const view = V.create(canvas, () => draw());

  // Scene --------------------------------------------------------------------------------------

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

  const kTraces = 12;

  function draw() {
    if (!view) return;
    const now = S.at(data, played, time), kind = $('shapes').value, items = [];
    addState(items, now.state, kind === 'both' ? 'exact' : kind, 1);
    if (kind === 'both') addState(items, now.state, 'sets', 0.35, (shape) => shape.exact);
    const step = played.steps[now.index];
    if ($('trace').checked && step && step.parts.length > 0)
      for (let k = 0; k < kTraces; ++k) {
        const then = step.begin + (step.end - step.begin) * k / kTraces;
        const moving = step.parts.filter((p) => p.begin <= then).pop().motion;
        addState(items, S.at(data, played, then).state, kind, 0.12, (shape) => shape.robot === moving.robot ||
          (shape.object !== undefined && moving.holds[shape.object] !== undefined));
      }
    view.draw(items);
  }

  // Time ---------------------------------------------------------------------------------------

  let choices = [], played = S.branch(data, choices), time = 0, playing = false, before = 0, shown = -2;

  /// What the branch that is played ends with.
  function ending() {
    const last = played.steps[played.steps.length - 1];
    return last && data.steps[last.number].ways[last.way].unplanned ? 'left out by assumption: the plan has no branch for this' : 'goal';
  }

  function listSteps() {
    $('steps').replaceChildren(...played.steps.map((step, index) => {
      const item = document.createElement('li'), {ways, node} = data.steps[step.number];
      item.textContent = data.nodes[node].action || '(looks)';
      const small = document.createElement('small');
      small.textContent = `  ${step.begin.toFixed(1)} s`;
      item.append(small);
      if (ways.some((way) => way.outcome)) {
        const select = document.createElement('select');
        ways.forEach((way, k) => select.add(new Option((way.outcome || 'goes on') + (way.unplanned ? ' (left out)' : ''), k, false, k === step.way)));
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
    end.textContent = ending();
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
      if (view) $('message').textContent = index < 0 || played.steps.length === 0 ? '' : over ? ending() : data.nodes[node].action;
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

  // #t=12.5 begins there: for pictures of a page.
  V.setWanted();
  if (view) {
    view.frame(boxes());
    view.place();
  }
  const unplanned = new Set(data.steps.flatMap((step) => step.ways.filter((way) => way.unplanned).map((way) => way.outcome)));
  $('unplanned').hidden = unplanned.size === 0;
  $('unplanned').textContent = `Made under assumptions: there is no branch for ${[...unplanned].join(', ')}.`;
  if (played.steps.length === 0) document.body.classList.add('still');
  choose(Number(V.wanted().get('t')) || 0);
})();

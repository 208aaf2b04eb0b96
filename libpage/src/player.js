// Has view.js draw what scene.js says, and moves through time.
'use strict';

(() => {
  const S = KaboumScene, V = KaboumView;
  const data = JSON.parse(document.getElementById('data').textContent);
  const $ = (id) => document.getElementById(id);
  const canvas = $('canvas');
  const view = V.create(canvas, () => draw());

  const cell = KaboumCell(data, view);

  // Scene --------------------------------------------------------------------------------------

  const kTraces = 12;

  function draw() {
    if (!view) return;
    const now = S.at(data, played, time), kind = $('shapes').value, items = cell.items(now.state);
    const step = played.steps[now.index];
    if ($('trace').checked && step && step.parts.length > 0)
      for (let k = 0; k < kTraces; ++k) {
        const then = step.begin + (step.end - step.begin) * k / kTraces;
        const moving = step.parts.filter((p) => p.begin <= then).pop().motion;
        cell.addState(items, S.at(data, played, then).state, kind, 0.12, (shape) => shape.robot === moving.robot ||
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
    view.frame(cell.boxes());
    view.place();
  }
  const unplanned = new Set(data.steps.flatMap((step) => step.ways.filter((way) => way.unplanned).map((way) => way.outcome)));
  $('unplanned').hidden = unplanned.size === 0;
  $('unplanned').textContent = `Made under assumptions: there is no branch for ${[...unplanned].join(', ')}.`;
  if (played.steps.length === 0) document.body.classList.add('still');
  choose(Number(V.wanted().get('t')) || 0);
})();

// The page of a run: follows it while it goes on, and plays it again.
'use strict';

(() => {
  const V = KaboumView;
  const data = JSON.parse(document.getElementById('data').textContent);
  const $ = (id) => document.getElementById(id);
  const view = V.create($('canvas'), () => draw());
  const cell = KaboumCell(data, view), run = KaboumRun.create(data), live = !data.events;

  let time = 0, playing = false, before = 0, arrived = performance.now(), waiting = false;
  let shownRow = -2, shownPlan = -2, shownNode = -2, shownKnown = null, listed = 0, lost = false;

  function draw() {
    const at = run.at(time);
    if (view) view.draw(cell.items(at ? at.state : data.states[0]));
  }

  // What is said ---------------------------------------------------------------------------------

  function showStatus() {
    const name = run.plans[0] && run.plans[0].name ? `Run of ${run.plans[0].name}` : 'Run';
    if (document.title !== name) document.title = $('title').textContent = name;
    $('title').title = run.driver;
    const verdict = run.verdict ? `, ${run.verdict.verdict}: ${run.verdict.samples} samples, ${run.verdict.collisions} collisions` : '';
    $('status').textContent = run.ended ? `ended: ${run.ended.text}${verdict}`
      : lost ? 'the program that ran this has ended' : live ? (run.events ? `live, ${(run.t || 0).toFixed(1)} s` : 'waiting for the run to begin') : 'the journal ends here';
    $('status').classList.toggle('live', live && !run.ended && !lost);
    $('following').hidden = !live;
  }

  /// Rows are only added, but for the note of the last one.
  function listRows() {
    const list = $('rows');
    for (const k of [listed - 1, ...Array.from({length: run.rows.length - listed}, (_, i) => listed + i)]) {
      if (k < 0) continue;
      const row = run.rows[k];
      let item = list.children[k];
      if (!item) {
        item = document.createElement('li');
        if (row.kind !== 'step') item.classList.add(row.kind);
        item.append(row.text, document.createElement('small'));
        item.onclick = () => { leave(); show(row.begin); };
        list.append(item);
      }
      item.querySelector('small').textContent = `${row.t.toFixed(1)} s ${row.note}`;
    }
    listed = run.rows.length;
  }

  function showPlan(moment) {
    if (moment.plan !== shownPlan) {
      shownPlan = moment.plan;
      shownNode = -2;
      // Drawn by the program, from the plan's graph.
      const plan = run.plans[shownPlan];
      $('graph').innerHTML = plan ? plan.svg : '';
      if (plan && plan.undrawn) $('graph').textContent = `The plan has ${plan.undrawn} nodes: too many to be drawn. The steps are all listed.`;
    }
    if (moment.node === shownNode) return;
    shownNode = moment.node;
    const done = new Set(run.rows.slice(0, moment.row).filter((row) => row.plan === shownPlan).map((row) => 'node-' + row.node));
    document.querySelectorAll('#graph [id^="node-"]').forEach((box) => {
      const now = box.id === 'node-' + shownNode;
      box.classList.toggle('now', now);
      box.classList.toggle('done', done.has(box.id));
      if (now && box.scrollIntoView && !$('graph').hidden) box.scrollIntoView({block: 'nearest'});
    });
  }

  /// A value that is a configuration, a pose or a grasp is where something is.
  const isPlace = (fact) => /^(conf|pose|grasp)\(.*\) (=|!=) /.test(fact);

  function showKnown(moment) {
    if (shownKnown === moment.known) return;
    shownKnown = moment.known;
    const fresh = new Set(moment.learned);
    const item = (fact, kind) => {
      const out = document.createElement('li');
      out.textContent = fact;
      if (kind) out.className = kind;
      return out;
    };
    const wanted = (fact) => $('places').checked || !isPlace(fact);
    $('known').replaceChildren(...moment.known.filter(wanted).map((fact) => item(fact, fresh.has(fact) ? 'learned' : '')),
                               ...moment.gone.filter(wanted).map((fact) => item(fact, 'gone')));
  }

  function show(at) {
    time = Math.max(0, Math.min(at, run.duration));
    $('time').max = run.duration;
    $('time').value = time;
    $('clock').textContent = `${time.toFixed(2)} of ${run.duration.toFixed(2)} s of motion`;
    const now = run.at(time);
    if (now) {
      const {moment} = now;
      $('message').textContent = view ? moment.text : $('message').textContent;
      if (moment.row !== shownRow) {
        [...$('rows').children].forEach((item, k) => item.classList.toggle('now', k === moment.row));
        const item = $('rows').children[moment.row];
        if (item && item.scrollIntoView) item.scrollIntoView({block: 'nearest'});
        shownRow = moment.row;
      }
      showPlan(moment);
      showKnown(moment);
    }
    draw();
  }

  // Time -----------------------------------------------------------------------------------------

  const follows = () => live && $('follow').checked;

  /// Looks at another time than now.
  function leave() {
    play(false);
    $('follow').checked = false;
  }

  function tick(now) {
    if (follows()) {
      const to = run.now((now - arrived) / 1000);
      if (to !== time || run.events !== tick.events) show(to);
      tick.events = run.events;
      requestAnimationFrame(tick);
      return;
    }
    if (!playing) { tick.going = false; return; }
    show(time + (now - before) / 1000 * Number($('speed').value));
    before = now;
    if (time >= run.duration && (!live || run.ended || lost)) { play(false); tick.going = false; }
    else requestAnimationFrame(tick);
  }

  function go() {
    if (tick.going) return;
    tick.going = true;
    before = performance.now();
    requestAnimationFrame(tick);
  }

  function play(on) {
    playing = on;
    $('play').textContent = on ? 'pause' : 'play';
    if (!on) return;
    $('follow').checked = false;
    if (time >= run.duration) show(0);
    before = performance.now();
    go();
  }

  $('play').onclick = () => play(!playing);
  $('time').oninput = () => { const to = Number($('time').value); leave(); show(to); };
  $('follow').onchange = () => { play(false); if (follows()) go(); };
  for (const id of ['shapes', 'robots', 'objects', 'bodies', 'edges', 'explode']) $(id).oninput = draw;
  $('places').oninput = () => { shownKnown = null; show(time); };
  for (const radio of document.querySelectorAll('[name=list]'))
    radio.onchange = () => { $('rows').hidden = radio.value !== 'rows'; $('graph').hidden = radio.value !== 'graph'; };
  document.onkeydown = (event) => {
    if (['INPUT', 'SELECT', 'BUTTON'].includes(event.target.tagName)) return;
    if (event.key === ' ') { event.preventDefault(); play(!playing); }
    if (event.key === 'ArrowRight') { leave(); show(time + 0.1); }
    if (event.key === 'ArrowLeft') { leave(); show(time - 0.1); }
  };

  // Events ---------------------------------------------------------------------------------------

  /// Lists what has come, once for all that comes at a time.
  function changed() {
    waiting = false;
    listRows();
    showStatus();
    if (!follows()) show(time);
  }

  function add(event) {
    run.add(event);
    arrived = performance.now();
    if (waiting) return;
    waiting = true;
    setTimeout(changed, 0);
  }

  function listen() {
    const source = new EventSource('events');
    let last = 0;
    source.onmessage = (message) => {
      const number = Number(message.lastEventId.split('-')[1]);  // RUN-NUMBER
      if (number !== last + 1) return;  // one that is here already
      last = number;
      lost = false;
      const event = JSON.parse(message.data);
      add(event);
      if (event.verdict) source.close();  // the last one
    };
    source.onerror = () => {
      lost = !run.ended;
      showStatus();
    };
  }

  // #t=12.5 begins there: for pictures of a page.
  V.setWanted();
  for (const radio of document.querySelectorAll('[name=list]'))
    if (V.wanted().get('list') === radio.value) { radio.checked = true; radio.onchange(); }
  if (view) {
    view.frame(cell.boxes());
    view.place();
  }
  if (live) {
    showStatus();
    draw();
    listen();
    go();
  } else {
    data.events.forEach(run.add);
    changed();
    show(Number(V.wanted().get('t')) || 0);
  }
})();

// A run that is carried out, from the events of its journal: where everything is at a time, what is known then,
// which step it is. No drawing: also run by the tests.
'use strict';

const KaboumRun = (() => {
  const S = typeof KaboumScene !== 'undefined' ? KaboumScene : require('./scene.js');

  // What takes no time of its own is shown for so long. [s]
  const kPause = 0.5;

  /// Three rows of a matrix as a pose of scene.js.
  const poseOf = (rows) => [...rows.flatMap((row) => row.slice(0, 3)), ...rows.map((row) => row[3])];

  /// A run without events. `add` gets them in their order.
  ///
  /// `moments` follow each other: each has `begin` and `end` [s], the `state` at its beginning, what is `known`
  /// (sentences, sorted), which of it is new (`learned`) and what is not known any more (`gone`), the number of its
  /// `row`, of its `plan` and `node`, a `text`, and perhaps a `motion`: robot, times, positions. Time is that of
  /// motions as they were told or, where the driver has said that, executed; `t` is that of the run.
  /// `rows` are what a list shows: steps, plans, the end.
  function create(data) {
    const index = (names) => new Map(names.map((name, i) => [name, i]));
    const robots = index(data.robots.map((r) => r.name));
    const links = data.robots.map((r) => index(r.links));
    const objects = new Map(data.shapes.filter((s) => s.object !== undefined).map((s) => [s.name, s.object]));
    const run = {moments: [], rows: [], plans: [], events: 0, driver: '', ended: null, verdict: null, duration: 0, running: null};
    let state = data.states[0], known = [], learned = [], gone = [], plan = -1, node = -1, t = 0, said = '';

    /// A moment more, from the state now.
    function add(text, lasts, motion) {
      const moment = {begin: run.duration, end: run.duration + lasts, t, state, known, learned, gone, row: run.rows.length - 1, plan, node, text,
                      motion: motion || null};
      run.duration = moment.end;
      run.moments.push(moment);
      return moment;
    }

    function addRow(kind, text, note) {
      run.rows.push({kind, text, note: note || '', begin: run.duration, t, plan, node});
    }

    /// What an event says of where things are and what is known.
    function change(event) {
      const q = state.q.slice(), places = state.places.slice();
      for (const [name, values] of Object.entries(event.q || {})) if (robots.has(name)) q[robots.get(name)] = values;
      for (const [name, place] of Object.entries(event.objects || {})) {
        if (!objects.has(name)) continue;
        const robot = robots.get(place.held_by), object = objects.get(name);
        if (place.away) places[object] = {away: true};
        else if (robot === undefined) places[object] = {pose: poseOf(place.pose)};
        else if (place.pose) places[object] = {robot, link: links[robot].get(place.link) || 0, pose: poseOf(place.pose)};
      }
      state = {q, places};
      const lost = new Set(event.gone || []);
      if (lost.size > 0 || (event.learned || []).length > 0) {
        known = [...known.filter((fact) => !lost.has(fact)), ...(event.learned || [])].sort();
        learned = event.learned || [];
        gone = event.gone || [];
      }
    }

    function take(message) {
      const robot = robots.get(message.robot), object = objects.get(message.object);
      if (robot === undefined || object === undefined) return;
      const link = links[robot].get(message.link) || 0, pose = S.objectPose(data, state, object);
      if (!pose) return;
      const frame = S.forward(data.robots[robot], state.q[robot])[link], places = state.places.slice();
      places[object] = {robot, link, pose: S.multiply(S.inverse(frame), pose)};
      state = {q: state.q, places};
    }

    function release(message) {
      const object = objects.get(message.object), place = state.places[object];
      if (!place || place.robot !== robots.get(message.robot)) return;  // handed over: another one has it
      const places = state.places.slice();
      places[object] = {pose: S.objectPose(data, state, object)};
      state = {q: state.q, places};
    }

    /// Where a motion has left its robot.
    function arrive(robot, q) {
      const all = state.q.slice();
      all[robot] = q;
      state = {q: all, places: state.places};
    }

    function told(message) {
      run.running = {message, moment: null};
      if (message.do === 'begin') change({q: Object.fromEntries(Object.entries(message.robots || {}).map(([name, r]) => [name, r.q])), objects: message.objects});
      if (message.do === 'move' && message.trajectory && robots.has(message.robot)) {
        const {times, positions} = message.trajectory, robot = robots.get(message.robot);
        run.running.moment = add(`${said}: ${message.robot} moves`, times[times.length - 1], {robot, times, positions});
      }
      if (message.do === 'take' || message.do === 'release') {
        (message.do === 'take' ? take : release)(message);
        add(`${said}: ${message.robot} ${message.do === 'take' ? 'takes' : 'lets go of'} ${message.object}`, kPause / 2);
      }
      if (message.do === 'sense') run.running.moment = add(`senses ${message.fact}`, kPause / 2);
    }

    function heard(answer) {
      const asked = run.running;
      run.running = null;
      if (!asked || answer.id !== asked.message.id) return;
      const {message, moment} = asked;
      if (answer.failed !== undefined) {
        addRow('fault', `${message.do} failed: ${answer.failed}`);
        add(`${said}: ${message.do} failed: ${answer.failed}`, kPause);
      }
      if (message.do === 'move' && moment) {
        const {robot, positions} = moment.motion, done = answer.executed;
        if (done && done.times.length > 0) {
          // It was last, unless it failed: then a moment follows, and keeps its place.
          if (run.moments[run.moments.length - 1] === moment) run.duration = moment.end = moment.begin + done.times[done.times.length - 1];
          moment.motion = {robot, times: done.times, positions: done.positions, told: moment.motion};
        }
        if (answer.failed === undefined) arrive(robot, Array.isArray(answer.q) && answer.q.length === positions[0].length ? answer.q : positions[positions.length - 1]);
      }
      if (message.do === 'sense' && answer.sensed !== undefined) {
        const text = `${message.fact} is ${answer.sensed}`;
        if (run.rows.length > 0) run.rows[run.rows.length - 1].note += `${run.rows[run.rows.length - 1].note ? ', ' : ''}${text}`;
        add(text, kPause);
      }
    }

    function begun(event) {
      node = event.node;
      change(event);
      said = event.action || '(looks)';
      addRow('step', said);
      add(said, event.action ? 0 : kPause);
    }

    function done(event) {
      change(event);
      const last = run.rows[run.rows.length - 1];
      add(said, last && last.begin === run.duration ? kPause : 0);
      if (event.unplanned) add(`${event.outcome}: the plan has no branch for this`, kPause);
    }

    function again({outcome, actions_before: actions}) {
      addRow('fault', 'plans again', `${outcome}, and the plan has no branch for that (after ${actions} actions)`);
      add(`plans again: ${outcome}, and the plan has no branch for that`, kPause);
    }

    function planned({status, reason, nodes, wall_seconds: seconds, circle}) {
      const found = status === 'solved' && !circle;
      const text = found ? `a new plan of ${nodes} nodes, after ${Number(seconds).toPrecision(2)} s` : `no plan: ${reason || status}`;
      if (run.rows.length > 0) run.rows[run.rows.length - 1].note += `: ${text}`;
      add(text, kPause);
    }

    function end(kind, text) {
      run.ended = {kind, text};
      run.running = null;
      addRow(kind, text);
      add(text, kPause);
    }

    /// @return whether it could be read
    run.add = (event) => {
      ++run.events;
      if (typeof event.t === 'number') t = run.t = event.t;
      try {
        if (event.kaboum_journal) run.driver = event.driver || '';
        if (event.unread || event.dropped) addRow('fault', event.unread ? 'an entry of the journal that cannot be read' : 'there is more than a page can show');
        if (event.plan !== undefined && event.step === undefined) {
          plan = event.plan;
          node = -1;
          run.plans[plan] = {svg: event.svg || '', undrawn: event.undrawn || 0, name: event.name || ''};
        }
        if (event.step !== undefined) begun(event);
        if (event.step_done !== undefined) done(event);
        if (event.replanning) again(event.replanning);
        if (event.replanned) planned(event.replanned);
        if (event.told && event.told.do) told(event.told);
        if (event.heard && event.heard.id !== undefined) heard(event.heard);
        if (event.finished) end('goal', 'goal');
        if (event.stopped) end('fault', `stopped (${event.stopped}): ${event.why}`);
        if (event.verdict) run.verdict = event;
      } catch (error) {
        addRow('fault', `an event that cannot be shown: ${error.message}`);
        return false;
      }
      return true;
    };

    /// The moment of a time, and the state then. Null: there is none yet.
    run.at = (time) => {
      if (run.moments.length === 0) return null;
      let low = 0, high = run.moments.length - 1;
      while (low < high) {  // the last one that has begun
        const middle = (low + high + 1) >> 1;
        if (run.moments[middle].begin <= time) low = middle;
        else high = middle - 1;
      }
      const moment = run.moments[low];
      if (!moment.motion) return {moment, state: moment.state};
      const q = moment.state.q.slice();
      q[moment.motion.robot] = between(moment.motion, time - moment.begin);
      return {moment, state: {q, places: moment.state.places}};
    };

    /// Where it is now: the end, or in a motion that was begun so many seconds ago.
    run.now = (seconds) => {
      const moment = run.running && run.running.moment;
      return moment && moment.motion ? Math.min(moment.begin + seconds, moment.end) : run.duration;
    };

    return run;
  }

  /// Positions of a motion at a time from its beginning.
  function between({times, positions}, time) {
    let k = 0;
    while (k + 1 < times.length && times[k + 1] <= time) ++k;
    if (k + 1 >= times.length) return positions[positions.length - 1];
    const share = Math.max(0, Math.min(1, (time - times[k]) / (times[k + 1] - times[k])));
    return positions[k].map((x, j) => x + share * (positions[k + 1][j] - x));
  }

  return {create, poseOf};
})();

if (typeof module !== 'undefined') module.exports = KaboumRun;

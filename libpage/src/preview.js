// Original and result over each other: layers that are shown, transparent or hidden, their distances in
// colours, bodies apart.
'use strict';

(() => {
  const S = KaboumScene, V = KaboumView;
  const data = JSON.parse(document.getElementById('data').textContent);
  const $ = (id) => document.getElementById(id);
  const element = (tag, text) => { const e = document.createElement(tag); e.textContent = text; return e; };
  const view = V.create($('canvas'), () => draw());
  const grey = [0.72, 0.72, 0.72];
  const number = (x) => String(Number(x.toPrecision(3)));

  // Words --------------------------------------------------------------------------------------

  for (const [name, words] of data.facts) $('facts').append(element('dt', name), element('dd', words));
  $('note').textContent = data.note;
  if (data.table)
    for (const [i, cells] of [data.table.head, ...data.table.rows].entries()) {
      const row = document.createElement('tr');
      row.append(...cells.map((cell) => element(i === 0 ? 'th' : 'td', cell)));
      row.className = i > 0 && data.table.bad.includes(i - 1) ? 'bad' : '';
      $('table').append(row);
    }
  $('steps').hidden = !data.steps;
  for (const {name, words, command} of data.steps || []) {
    const line = element('p', name);
    if (words) line.append(': ' + words);
    $('steps').append(line, element('pre', command));
  }
  if (data.largest !== null) {
    $('meaning').textContent = data.meaning + (data.unit ? ` [${data.unit}]` : ", in the file's unit");
    $('scale').style.background = `linear-gradient(to right, ${V.heat.map((c) => `rgb(${c.map((x) => Math.round(255 * x))})`)})`;
    $('ticks').append(...[0, 0.25, 0.5, 0.75, 1].map((x) => element('span', number(x * data.largest))));
    $('within').hidden = !data.layers.some((layer) => layer.distances && layer.bodies);
  } else {
    $('colours').querySelector('[value=distance]').remove();
  }

  // Layers -------------------------------------------------------------------------------------

  let bodies = 0;
  const layers = data.layers.map((layer, index) => {
    const label = element('label', layer.name + ' '), select = document.createElement('select');
    select.id = 'layer' + index;
    for (const [value, words] of [['shown', 'shown'], ['clear', 'transparent'], ['hidden', 'hidden']])
      select.add(new Option(words, value, false, value === layer.view));
    select.oninput = () => draw();
    label.append(select);
    $('layers').append(label, ' ');
    // What belongs to one link moves with it; all else is one.
    const groups = new Map();
    for (const shape of layer.shapes) groups.set(shape.link, [...(groups.get(shape.link) || []), S.mesh(shape)]);
    const parts = view ? [...groups].map(([link, meshes]) => {
      const first = bodies;
      bodies += meshes.length;
      return {link, buffers: view.upload(meshes, first, layer.edges === 'all' ? 1 - 1e-6 : 0.9)};
    }) : [];
    return {...layer, select, parts};
  });
  const apart = data.layers.some((layer) => layer.bodies && layer.shapes.length > 1);
  if (!apart) $('colours').querySelector('[value=bodies]').remove();
  $('exploding').hidden = !apart;
  $('moving').hidden = !data.path || data.path.length < 2;
  if (!view) $('message').textContent = 'This browser has no WebGL: nothing can be drawn.';

  // Joints -------------------------------------------------------------------------------------

  const sliders = (data.variables || []).map((variable, index) => {
    const label = document.createElement('label'), input = document.createElement('input'), value = document.createElement('output');
    Object.assign(input, {type: 'range', id: 'joint' + index, min: variable.low, max: variable.high, step: 'any', value: variable.value});
    input.disabled = variable.low === variable.high;
    label.title = `${variable.name}: ` + (variable.limited ? `${S.valueText(variable, variable.low)} to ${S.valueText(variable, variable.high)}` : 'no limits');
    label.append(element('span', variable.name), input, value);
    $('joints').append(label);
    input.oninput = () => draw();
    return {input, value, variable};
  });
  $('joints').hidden = sliders.length === 0;
  $('rest').onclick = () => { for (const {input, variable} of sliders) input.value = variable.value; draw(); };

  function linkPoses() {
    if (!data.robot) return [];
    if (sliders.length === 0) return S.forward(data.robot, S.pathAt(data.path, Number($('time').value)));
    for (const {input, value, variable} of sliders) value.textContent = S.valueText(variable, Number(input.value));
    return S.forward(data.robot, sliders.map(({input}) => Number(input.value)));
  }

  function draw() {
    if (!view) return;
    const colours = $('colours').value, items = [], links = linkPoses();
    $('legend').hidden = colours !== 'distance' || data.largest === null;
    layers.forEach((layer, index) => {
      const mode = layer.select.value;
      if (mode === 'hidden') return;
      const paint = colours === 'distance' && layer.distances ? 'value' : colours === 'bodies' && layer.bodies ? 'body' : 'colour';
      for (const {link, buffers} of layer.parts)
        items.push({buffers, pose: link === undefined ? S.identity : links[link], paint, glass: index,
                    colour: layer.colour || (paint === 'value' || !layer.result ? grey : V.palette[index % V.palette.length]),
                    alpha: mode === 'clear' ? 0.45 : 1, explode: layer.bodies ? Number($('explode').value) : 0, edges: $('edges').checked && layer.edges !== 'none'});
    });
    view.draw(items);
  }

  V.setWanted();
  for (const id of ['colours', 'edges', 'explode', 'time']) $(id).oninput = draw;
  if (view) {
    const links = linkPoses();
    view.frame(layers.flatMap((layer) => layer.parts.map(({link, buffers}) =>
      ({corners: buffers.corners, pose: link === undefined ? S.identity : links[link]}))));
    view.place();
  }
  draw();
})();

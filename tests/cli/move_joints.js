// The sliders of a robot's page, without drawing: node move_joints.js PAGE Q1,Q2,...
// Runs the page's own scripts with a document that is a stub, moves the sliders, and prints as JSON the sliders as the
// page has them, and where it draws each link: {"sliders": [{"name", "low", "high", "value", "words"}], "poses": {"1": [12 numbers]}}.
'use strict';
const fs = require('fs'), vm = require('vm'), assert = require('assert');

const [file, values] = process.argv.slice(2);
const page = fs.readFileSync(file, 'utf8');
const scripts = [...page.matchAll(/<script([^>]*)>\n?([^]*?)<\/script>/g)].map((m) => m[2]);

function element(tag) {
  const out = {tag, children: [], style: {}, classList: {toggle: () => {}}, hidden: false, textContent: ''};
  out.append = (...children) => out.children.push(...children);
  out.add = (option) => { out.children.push(option); if (option.selected) out.value = option.value; };
  out.querySelector = () => ({remove: () => {}});
  return out;
}
const named = new Map();
const document = {
  createElement: element,
  getElementById: (id) => {
    if (!named.has(id)) named.set(id, Object.assign(element('div'), id === 'data' ? {textContent: scripts[0]} : {value: id === 'colours' ? 'plain' : '0', checked: true}));
    return named.get(id);
  },
};
let drawn = [];
const view = {upload: () => ({corners: []}), draw: (items) => { drawn = items; }, frame: () => true, place: () => {}};
const context = vm.createContext({
  document, atob, console, Uint8Array, Float32Array, Uint32Array, Math, Map,
  Option: function (words, value, byDefault, selected) { Object.assign(this, {words, value, selected}); },
  KaboumView: {create: () => view, palette: [[0, 0, 0]], heat: [[0, 0, 0]], setWanted: () => {}},
});
vm.runInContext(scripts[1] + '\n' + scripts[3], context);

const data = JSON.parse(scripts[0]);
const labels = named.get('joints').children, inputs = labels.map((label) => label.children[1]);
assert.strictEqual(inputs.length, data.variables.length, 'a slider for each variable');
const first = inputs.map((input) => Number(input.value));
if (values) {
  values.split(',').forEach((value, i) => { inputs[i].value = value; });
  inputs[0].oninput();
}
const links = data.layers.flatMap((layer) => [...new Set(layer.shapes.map((shape) => shape.link))]);
assert.strictEqual(links.length, drawn.length, 'each link of each layer is drawn');
const sliders = labels.map(({children: [name, input, value]}, i) =>
  ({name: name.textContent, low: Number(input.min), high: Number(input.max), value: first[i], words: value.textContent}));
console.log(JSON.stringify({sliders, poses: Object.fromEntries(links.map((link, i) => [link, drawn[i].pose]))}));
named.get('rest').onclick();
assert.deepStrictEqual(inputs.map((input) => Number(input.value)), first, 'back to the first values');

// One plot per expression: a line per method with its interval and a dot per target, anchors as rules.

import {plot, axisX, axisY, dot, link, ruleX} from '@observablehq/plot';
import {element, shown} from './dom.js';

const least = -1;  // what is far below doing nothing is drawn at the border

function marks(page, code) {
  const methods = page.data.methods.filter(m => m.name !== 'nothing');
  const results = methods.map(m => ({...page.result(m.name, code), title: m.title, judged: m.judged})).filter(r => r.explained !== null && r.explained !== undefined);
  const clip = value => Math.max(least, value);
  const targets = page.targets.filter(t => t.expression === code).map(t => ({...t, title: page.method(t.method)?.title ?? t.method, x: clip(t.explained)}));
  const floors = page.data.anchors.filter(a => a.explained[code] !== null && a.explained[code] !== undefined);
  return {methods, results, targets, floors, clip};
}

function intervalPlot(page, code, width) {
  const {methods, results, targets, floors, clip} = marks(page, code);
  const titles = methods.map(m => m.title).filter(title => results.some(r => r.title === title));
  const left = Math.min(150, 18 + 7 * Math.max(...titles.map(t => t.length), 4));
  const low = Math.min(0, ...results.map(r => clip(r.low ?? r.explained)), ...targets.map(t => t.x));
  return plot({
    width, height: 62 + 24 * titles.length, marginLeft: left, marginTop: 8, marginBottom: 38,
    style: {background: 'transparent', fontSize: '12px'},
    x: {domain: [Math.floor(low * 10) / 10, 1.02], label: 'explained fraction', ticks: 5, tickFormat: d => shown(d, 1)},
    y: {domain: titles, label: null},
    ariaLabel: `Explained fractions of ${page.label(code)}`,
    ariaDescription: results.map(r => `${r.title} ${shown(r.explained, 2)}`).join(', '),
    marks: [
      axisX({ticks: 5, label: 'explained fraction'}), axisY({tickSize: 0, label: null, lineWidth: 12}),
      ruleX([0], {stroke: 'currentColor', strokeWidth: 1.5}),
      ruleX([1], {stroke: 'currentColor', strokeWidth: 1.5}),
      ruleX(floors, {x: a => a.explained[code], stroke: 'currentColor', strokeDasharray: '4 3', title: a => `${a.title} ${shown(a.explained[code], 2)}`}),
      dot(targets, {x: 'x', y: 'title', r: 2, fill: 'currentColor', fillOpacity: 0.35}),
      link(results.filter(r => r.low !== null), {x1: r => clip(r.low), x2: r => clip(r.high), y1: 'title', y2: 'title', stroke: 'var(--accent)', strokeWidth: 4, strokeLinecap: 'round'}),
      dot(results.filter(r => r.judged), {x: r => clip(r.explained), y: 'title', r: 5, fill: 'var(--accent)', stroke: 'var(--ground)'}),
      dot(results.filter(r => !r.judged), {x: r => clip(r.explained), y: 'title', r: 5, symbol: 'diamond', fill: 'var(--ground)', stroke: 'var(--accent)', strokeWidth: 2}),
    ],
  });
}

export function intervalPlots(page) {
  const grid = element('div', {class: 'plots'});
  const codes = page.data.expressions.map(e => e.code);
  const figures = codes.map(code => element('figure', {}));
  grid.append(...figures);
  let drawn = 0;
  const draw = () => {
    const width = Math.floor(figures[0]?.clientWidth ?? 0);
    if (width < 50 || width === drawn) return;
    drawn = width;
    codes.forEach((code, k) => {
      const unknown = page.data.anchors.filter(a => a.explained[code] === null || a.explained[code] === undefined).map(a => a.title);
      figures[k].replaceChildren(element('figcaption', {}, page.label(code)), intervalPlot(page, code, width),
        unknown.length ? element('small', {class: 'soft'}, `unknown: ${unknown.join(', ')}`) : '');
    });
  };
  new ResizeObserver(draw).observe(grid);
  const key = element('p', {class: 'soft'}, 'Filled: methods. Diamonds: bounds that look at the truth. Dashed: floors. ',
    `What explains less than ${least} is drawn there.`);
  return element('div', {}, key, grid);
}

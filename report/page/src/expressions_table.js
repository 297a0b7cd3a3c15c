// Methods by expressions in colour: explained fractions, floors below. A cell leads to a face.

import {element, shown} from './dom.js';
import {sortableTable} from './sortable_table.js';

export function expressionsTable(page, colours, lead) {
  const codes = page.data.expressions.map(e => e.code);
  const rows = page.data.methods.filter(m => m.name !== 'nothing').map(method => {
    const row = {title: method.title, name: method.name, judged: method.judged};
    for (const code of codes) row[`e${code}`] = page.result(method.name, code)?.explained ?? null;
    row.all = page.result(method.name, page.overall)?.explained ?? null;
    return row;
  });
  const fixed = page.data.anchors.map(anchor => {
    const row = {title: anchor.title, anchor: true, all: null};
    for (const code of codes) row[`e${code}`] = anchor.explained[code];
    const known = codes.map(code => anchor.explained[code]).filter(value => value !== null && value !== undefined);
    if (known.length) row.all = known.reduce((sum, value) => sum + value, 0) / known.length;
    return row;
  });
  const cell = (row, code, value) => {
    if (value === null || value === undefined) return row.anchor ? 'unknown' : '–';
    if (row.anchor) return shown(value, 2);
    const look = {class: 'cell', style: {background: colours.css(value), color: colours.ink(value)}};
    if (code === null || !row.judged) return element('span', look, shown(value, 2));
    return element('button', {type: 'button', ...look, 'aria-label': `${row.title}, ${page.label(code)}: ${shown(value, 2)}; show a face`,
      onclick: () => lead({expression: code, method: row.name})}, shown(value, 2));
  };
  const table = sortableTable({
    caption: 'Explained fraction of each method (rows) and expression (columns); a cell leads to a face',
    rowClass: row => (row.anchor ? 'anchor' : row.judged ? '' : 'bound'),
    columns: [
      {key: 'title', title: 'method', text: true},
      ...page.data.expressions.map(e => ({key: `e${e.code}`, title: e.label, help: e.words, cell: row => cell(row, e.code, row[`e${e.code}`])})),
      {key: 'all', title: 'all', cell: row => cell(row, null, row.all)},
    ],
    rows, fixed,
  });
  const bar = element('div', {class: 'bar', 'aria-hidden': 'true'}, '0 or less', element('i', {style: {background: colours.gradient()}}), element('span', {}, '1'), element('span', {}, 'explained'));
  return element('div', {}, table, bar);
}

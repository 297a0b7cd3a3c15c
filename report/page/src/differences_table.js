// How sure it is that one method is truer than another.

import {choice, element, shown} from './dom.js';
import {sortableTable} from './sortable_table.js';

const chance = value => (value === null ? '–' : value < 0.001 ? '< 0.001' : shown(value, 3));

export function differencesTable(page) {
  const host = element('div');
  const codes = [...new Set(page.data.differences.map(d => d.expression))];
  const fill = code => host.replaceChildren(sortableTable({
    caption: `Differences in mm, ${code === '' ? 'over all expressions' : page.label(code)}`,
    columns: [
      {key: 'first', title: 'first', text: true},
      {key: 'second', title: 'second', text: true},
      {key: 'difference_mm', title: 'difference, mm', digits: 3},
      {key: 'low', title: 'interval', cell: row => (row.low === null ? 'too few subjects' : `${shown(row.low, 3)} to ${shown(row.high, 3)}`)},
      {key: 'dz', title: 'dz', digits: 2},
      {key: 'p', title: 'p', cell: row => chance(row.p)},
      {key: 'q', title: 'q', cell: row => chance(row.q)},
      {key: 'pairs', title: 'pairs', digits: 0},
    ],
    rows: page.data.differences.filter(d => d.expression === code),
    most: 40,
  }));
  if (codes.length === 0) return element('p', {}, 'There are no two methods to compare.');
  const start = codes.includes('') ? '' : codes[0];
  const chosen = choice('expression', codes.map(code => [code, page.label(code)]), start, fill);
  fill(start);
  return element('div', {}, element('div', {class: 'fields'}, chosen.field), host);
}

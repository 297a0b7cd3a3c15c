// A table that sorts: a button in every head, arrows and aria-sort say how it stands. Unknown values come last.

import {element, shown} from './dom.js';

/**
 * columns: {key, title, digits?, cell?(row), text?, help?}; rows: objects. fixed: rows that stay below, whatever the order.
 * most: how many are shown at first.
 */
export function sortableTable({caption, columns, rows, fixed = [], rowClass = () => '', most = Infinity}) {
  let key = null, ascending = true, limit = most;
  const body = element('tbody');
  const heads = columns.map(column => element('th', {scope: 'col', class: column.text ? 'text' : '', title: column.help},
    element('button', {type: 'button', onclick: () => sortBy(column)}, column.title)));
  const more = element('button', {type: 'button', class: 'plain', onclick: () => { limit = Infinity; fill(); }});
  const table = element('table', {}, element('caption', {}, caption), element('thead', {}, element('tr', {}, ...heads)), body);

  const compare = (a, b) => {
    if (a === b) return 0;
    if (a === null || a === undefined) return 1;
    if (b === null || b === undefined) return -1;
    const order = typeof a === 'number' ? a - b : String(a).localeCompare(String(b), 'en', {numeric: true});
    return ascending ? order : -order;
  };
  const line = row => element('tr', {class: rowClass(row)}, ...columns.map((column, k) => {
    const content = column.cell ? column.cell(row) : column.digits === undefined ? String(row[column.key] ?? '–') : shown(row[column.key], column.digits);
    return k === 0 ? element('th', {scope: 'row'}, content) : element('td', {class: column.text ? 'text' : ''}, content);
  }));
  function fill() {
    const order = key === null ? rows : [...rows].sort((a, b) => compare(a[key], b[key]));
    body.replaceChildren(...order.slice(0, limit).map(line), ...fixed.map(line));
    more.hidden = order.length <= limit;
    more.textContent = `Show all ${order.length} rows`;
  }
  function sortBy(column) {
    // Numbers begin with the greatest, words with A.
    ascending = key === column.key ? !ascending : Boolean(column.text);
    key = column.key;
    heads.forEach((head, k) => {
      if (columns[k].key === key) head.setAttribute('aria-sort', ascending ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    });
    fill();
  }
  fill();
  return element('div', {}, element('div', {class: 'wide', tabindex: 0, role: 'region', 'aria-label': caption}, table), more);
}

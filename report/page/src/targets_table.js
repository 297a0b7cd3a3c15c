// The error of every target, expression and method. A button leads to the face.

import {choice, element} from './dom.js';
import {sortableTable} from './sortable_table.js';

export function targetsTable(page, lead) {
  const host = element('div');
  const methods = [...new Set(page.targets.map(t => t.method))];
  const codes = page.data.expressions.map(e => e.code);
  let method = methods.at(-1) ?? '', code = '';
  const judged = methods.map(name => page.result(name, page.overall)).filter(Boolean);
  if (judged.length) method = judged.reduce((best, r) => ((r.explained ?? -9) > (best.explained ?? -9) ? r : best)).method;
  function fill() {
    const rows = page.targets.filter(t => t.method === method && (code === '' || t.expression === code))
      .map(t => ({...t, label: page.shortLabel(t.expression)}));
    host.replaceChildren(sortableTable({
      caption: `${rows.length} targets and expressions by ${method}`,
      columns: [
        {key: 'target', title: 'target', text: true, cell: row => element('button', {type: 'button', class: 'plain',
          'aria-label': `Show ${row.target}, ${row.label}, ${row.method}`,
          onclick: () => lead({target: row.target, expression: row.expression, method: row.method})}, row.target)},
        {key: 'label', title: 'expression', text: true},
        {key: 'explained', title: 'explained', digits: 3},
        {key: 'error_mm', title: 'error, mm', digits: 3},
        {key: 'nothing_mm', title: 'doing nothing, mm', digits: 3},
        {key: 'cases', title: 'cases', digits: 0},
      ],
      rows, most: 24,
    }));
  }
  const byMethod = choice('method', methods.map(name => [name, name]), method, value => { method = value; fill(); });
  const byCode = choice('expression', [['', 'all'], ...codes.map(c => [c, page.label(c)])], '', value => { code = value; fill(); });
  fill();
  const left = page.data.cases.left_out;
  return element('div', {}, element('div', {class: 'fields'}, byMethod.field, byCode.field), host,
    left > 0 ? element('p', {class: 'notice'}, `${left} more, neither the best nor the worst, are in rows.csv alone.`) : null);
}

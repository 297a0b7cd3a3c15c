// One row per method over all expressions.

import {element, shown} from './dom.js';
import {sortableTable} from './sortable_table.js';

export function methodsTable(page) {
  const rows = page.data.methods.filter(m => m.name !== 'nothing').map(m => ({...m, ...page.result(m.name, page.overall)}));
  const interval = row => (row.low === null || row.low === undefined ? 'too few subjects' : `${shown(row.low, 2)} to ${shown(row.high, 2)}`);
  return sortableTable({
    caption: `Methods over ${page.overall === '' ? 'all expressions' : page.label(page.overall)}`,
    rowClass: row => (row.judged ? '' : 'bound'),
    columns: [
      {key: 'title', title: 'method', text: true},
      {key: 'kind', title: 'learns from', text: true},
      {key: 'explained', title: 'explained', digits: 3},
      {key: 'low', title: 'interval', cell: interval},
      {key: 'error_mm', title: 'error, mm', digits: 3},
      {key: 'share', title: 'share of the bound', digits: 2, help: 'explained / explained by the true field of the same kind of source'},
      {key: 'explained_median', title: 'median case', digits: 2},
      {key: 'explained_whole_face', title: 'whole face', digits: 2},
      {key: 'worse_share', title: 'worse than nothing, %', cell: row => shown(row.worse_share === null ? null : 100 * row.worse_share, 1)},
      {key: 'lip_aperture_error_mm', title: 'lips, mm', digits: 1, help: 'median error of how far the lips are apart'},
      {key: 'still_skin_mm', title: 'still skin, mm', digits: 2, help: 'how far skin moves that should hold still'},
      {key: 'peak_ratio', title: 'peak / true', digits: 2},
      {key: 'cases', title: 'cases', digits: 0},
    ],
    rows,
  });
}

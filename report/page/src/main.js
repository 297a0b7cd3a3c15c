import {colourMap} from './colour_map.js';
import {differencesTable} from './differences_table.js';
import {element} from './dom.js';
import {expressionsTable} from './expressions_table.js';
import {FacePanel} from './face_panel.js';
import {intervalPlots} from './interval_plots.js';
import {methodsTable} from './methods_table.js';
import {readPage} from './page_data.js';
import {targetsTable} from './targets_table.js';

const page = readPage();
const colours = colourMap(page.data.colours);
const put = (id, ...children) => document.getElementById(id).replaceChildren(...children);

let panel = null;
if (page.faces?.faces.length) panel = new FacePanel(document.getElementById('face-panel'), page, colours);
else put('face-panel', element('p', {class: 'notice'}, 'This page holds no faces; mimik report OUT makes one with faces, where the workspace is there.'));

/** To a face: what is shown, then the eye and the keyboard. */
function lead(where) {
  panel?.goTo(where);
  document.getElementById('faces').scrollIntoView();
  panel?.canvas.focus({preventScroll: true});
}

put('methods-table', methodsTable(page));
put('expressions-table', expressionsTable(page, colours, lead));
put('interval-plots', intervalPlots(page));
put('targets-table', targetsTable(page, lead));
put('differences-table', differencesTable(page));

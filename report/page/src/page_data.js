// What the page was given (docs/report.md): numbers of the experiment, and faces.

const parse = id => JSON.parse(document.getElementById(id).textContent);

export function readPage() {
  const data = parse('page-data');
  const faces = parse('page-faces');
  const labels = new Map(data.expressions.map(e => [e.code, e.words ? `${e.label} ${e.words}` : e.label]));
  const shortLabels = new Map(data.expressions.map(e => [e.code, e.label]));
  const methods = new Map(data.methods.map(m => [m.name, m]));
  const results = new Map(data.results.map(r => [`${r.method}\n${r.expression}`, r]));
  const {cases} = data;
  const targets = cases.rows.map(([t, e, m, count, error, nothing]) => ({
    target: cases.targets[t], expression: cases.expressions[e], method: cases.methods[m], cases: count,
    error_mm: error, nothing_mm: nothing, explained: 1 - error / nothing,
  }));
  return {
    data, faces, targets,
    label: code => (code === '' ? 'all' : labels.get(code) ?? code),
    shortLabel: code => (code === '' ? 'all' : shortLabels.get(code) ?? code),
    method: name => methods.get(name),
    result: (method, expression) => results.get(`${method}\n${expression}`),
    /** The code that stands for all expressions: with one expression that is its own. */
    overall: data.expressions.length === 1 ? data.expressions[0].code : '',
  };
}

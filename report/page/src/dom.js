// Elements from values: text goes in as text and nothing else, so that no name of a file becomes markup.

export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'class') made.className = value;
    else if (name === 'style') Object.assign(made.style, value);
    else if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? '' : value);
  }
  made.append(...children.filter(child => child !== null && child !== undefined));
  return made;
}

export const unknown = '–';

/** A number as it is shown; what is not known is a dash. */
export function shown(value, digits) {
  return value === null || value === undefined ? unknown : value.toFixed(digits);
}

/** A labelled list to choose from. options: [value, text]. */
export function choice(label, options, chosen, take) {
  const list = element('select', {onchange: () => take(list.value)});
  for (const [value, text] of options) list.append(element('option', {value, selected: value === chosen}, text));
  return {field: element('label', {}, label, list), list};
}

/** A labelled tick box. */
export function tick(label, checked, take) {
  const box = element('input', {type: 'checkbox', checked, onchange: () => take(box.checked)});
  return {field: element('label', {class: 'tick'}, box, label), box};
}

// The colour map of the figures (figures/colour_map.h), which grows evenly in lightness. The page carries its colours.

export function colourMap(hexColours) {
  const colours = hexColours.map(hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16)));
  /** sRGB, 0 to 255, at t in [0, 1]. */
  const at = t => {
    const place = Math.min(1, Math.max(0, t)) * (colours.length - 1);
    const k = Math.min(colours.length - 2, Math.floor(place));
    return colours[k].map((c, channel) => c + (place - k) * (colours[k + 1][channel] - c));
  };
  const css = t => `rgb(${at(t).map(Math.round).join(' ')})`;
  return {
    at,
    css,
    /** Black or white, whichever is easier to read on the colour. */
    ink: t => {
      const [r, g, b] = at(t).map(c => ((c / 255 + 0.055) / 1.055) ** 2.4);
      return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.179 ? '#000' : '#fff';
    },
    gradient: () => `linear-gradient(to right, ${[...Array(17).keys()].map(k => css(k / 16)).join(', ')})`,
  };
}

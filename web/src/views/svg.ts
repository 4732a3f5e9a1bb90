// Elements of drawings in SVG.

const kSvg = 'http://www.w3.org/2000/svg';

/** @param content  text or children */
export function svg(
  tag: string,
  attributes: Readonly<Record<string, string | number>> = {},
  ...content: (string | Node)[]
): SVGElement {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, String(value));
  }
  element.append(...content);
  return element;
}

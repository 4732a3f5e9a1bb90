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

/** What style sheets say about drawings. */
const kStyles = [
  'fill',
  'fill-opacity',
  'stroke',
  'stroke-width',
  'font-family',
  'font-size',
  'font-weight',
  'text-anchor',
  'dominant-baseline',
] as const;

/** A drawing of the page as the content of a file: its styles are written into its elements. */
export function drawingContent(drawing: SVGElement): string {
  const copy = drawing.cloneNode(true) as SVGElement;
  const [from, to] = [drawing, copy].map((root) => [...root.querySelectorAll('*')]);
  from?.forEach((element, i) => {
    const styles = getComputedStyle(element);
    for (const name of kStyles) to?.[i]?.setAttribute(name, styles.getPropertyValue(name));
  });
  const text = new XMLSerializer();
  return [...copy.childNodes].map((child) => text.serializeToString(child)).join('');
}

// An arrangement of panels as short text for an address: base64url of JSON. A place is the names of
// its tabs, the one in front marked with "*": "scene *plots". A row or column is a list of sizes and
// parts: {"row":[300,"runs",700,"scene *plots"]}. Addresses come from anywhere: all of it is checked.
import type { LayoutNode, Split } from './layout_tree';
import { checkFields, checkLayout, LayoutError, quoted } from './layout_tree';

const kLongest = 2000;
/** Sizes are shares of this. */
const kWhole = 10_000;
const kFront = '*';

export function layoutText(tree: LayoutNode): string {
  return btoa(JSON.stringify(shortNode(tree)))
    .replaceAll('+', '-')
    .replaceAll('/', '_')
    .replace(/=+$/, '');
}

/** Errors: LayoutError, which names what is wrong. */
export function layoutOfText(text: string): LayoutNode {
  if (text.length > kLongest) {
    throw new LayoutError('panels', `${text.length} characters: must be at most ${kLongest}`);
  }
  return checkLayout(longNode(parsed(text), 'panels'), 'panels');
}

function shortNode(node: LayoutNode): unknown {
  if ('tabs' in node) {
    const { tabs, active } = node;
    const marked = tabs.map((name) => (name === active && name !== tabs[0] ? kFront + name : name));
    return marked.join(' ');
  }
  const whole = node.parts.reduce((sum, { size }) => sum + size, 0);
  // Edges are rounded, not sizes, so that their sum is always the same: the text of a text's
  // arrangement is that text.
  let [edge, end] = [0, 0];
  const parts = node.parts.flatMap((part) => {
    const begin = edge;
    end += part.size;
    edge = Math.max(begin + 1, Math.round((end / whole) * kWhole));
    return [edge - begin, shortNode(part.node)];
  });
  return { [node.split]: parts };
}

/** The arrangement in its long form, of which only checkLayout() knows whether it is in order. */
function longNode(value: unknown, field: string): unknown {
  if (typeof value === 'string') return longTabs(value);
  const fields = checkFields(value, field, ['row', 'column'] satisfies Split['split'][]);
  const [entry, second] = Object.entries(fields);
  if (entry === undefined || second !== undefined) {
    throw new LayoutError(field, 'must be a row or a column');
  }
  const [split, list] = entry;
  if (!Array.isArray(list) || list.length % 2 !== 0) {
    throw new LayoutError(`${field}.${split}`, 'must be a list of sizes and parts');
  }
  const parts = Array.from({ length: list.length / 2 }, (_, i) => ({
    size: list[2 * i] as unknown,
    node: longNode(list[2 * i + 1], `${field}.${split}[${i}]`),
  }));
  return { split, parts };
}

function longTabs(text: string): unknown {
  const names = text.split(' ');
  const tabs = names.map((name) => (name.startsWith(kFront) ? name.slice(1) : name));
  const front = names.findIndex((name) => name.startsWith(kFront));
  return { tabs, active: tabs[Math.max(0, front)] };
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(atob(text.replaceAll('-', '+').replaceAll('_', '/'))) as unknown;
  } catch {
    throw new LayoutError('panels', `${quoted(text)} is not an arrangement of panels`);
  }
}

// An arrangement of panels: tabs in rows and columns. It is stored, so it is checked when it is
// read.
import type { PanelName } from './panel_names';
import { isPanelName } from './panel_names';

/** Panels in one place, of which one is in front. */
export interface Tabs {
  tabs: PanelName[];
  active: PanelName;
}

export interface Split {
  split: 'row' | 'column';
  /** Sizes in any common unit; the parts of a row are columns or tabs, never rows, and vice versa. */
  parts: Part[];
}

export interface Part {
  size: number;
  node: LayoutNode;
}

export type LayoutNode = Tabs | Split;

const kDeepest = 12;
const kMostParts = 32;

/** The panels of an arrangement from left to right and from top to bottom. */
export function panelsOf(node: LayoutNode): PanelName[] {
  return 'tabs' in node ? [...node.tabs] : node.parts.flatMap((part) => panelsOf(part.node));
}

/** The panels in front. */
function frontPanels(node: LayoutNode): PanelName[] {
  return 'tabs' in node ? [node.active] : node.parts.flatMap((part) => frontPanels(part.node));
}

/** Whether both have the same tabs in the same places, and the same sizes up to `tolerance`. */
export function sameArrangement(a: LayoutNode, b: LayoutNode, tolerance = 0.01): boolean {
  if ('tabs' in a || 'tabs' in b) {
    return 'tabs' in a && 'tabs' in b && a.tabs.join() === b.tabs.join();
  }
  if (a.split !== b.split || a.parts.length !== b.parts.length) return false;
  const whole = (parts: readonly Part[]) => parts.reduce((sum, { size }) => sum + size, 0);
  const [all_a, all_b] = [whole(a.parts), whole(b.parts)];
  return a.parts.every((part, i) => {
    const other = b.parts[i];
    if (other === undefined) return false;
    const moved = Math.abs(part.size / all_a - other.size / all_b);
    return moved <= tolerance && sameArrangement(part.node, other.node, tolerance);
  });
}

/** Whether both have the same panels in front. */
export function sameFront(a: LayoutNode, b: LayoutNode): boolean {
  return frontPanels(a).join() === frontPanels(b).join();
}

/** Names the field that is wrong, and what it must be. */
export class LayoutError extends Error {
  constructor(field: string, problem: string) {
    super(`${field}: ${problem}`);
    this.name = 'LayoutError';
  }
}

/** @return null for anything that is not an arrangement in which every panel occurs once */
export function readLayout(value: unknown): LayoutNode | null {
  try {
    return checkLayout(value, 'layout');
  } catch (error) {
    if (error instanceof LayoutError) return null;
    throw error;
  }
}

/**
 * Reads an arrangement in which every panel occurs once. Errors: LayoutError.
 * @param field  names the value in errors
 */
export function checkLayout(value: unknown, field: string): LayoutNode {
  const node = readNode(value, field, null, kDeepest);
  const panels = panelsOf(node);
  const twice = panels.find((panel, i) => panels.indexOf(panel) !== i);
  if (twice !== undefined) throw new LayoutError(field, `the panel "${twice}" occurs twice`);
  return node;
}

/**
 * The fields of an object that has no others than these. Errors: LayoutError.
 * @param known  names that the object may have
 */
export function checkFields(
  value: unknown,
  field: string,
  known: readonly string[],
): Record<string, unknown> {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) {
    throw new LayoutError(field, 'must be an object');
  }
  const other = Object.keys(value).find((name) => !known.includes(name));
  if (other !== undefined) {
    throw new LayoutError(field, `has the unknown field ${quoted(other)}`);
  }
  return value as Record<string, unknown>;
}

/** A value of a file in a message: of limited length. */
export function quoted(value: unknown): string {
  const text = JSON.stringify(value) as string | undefined;
  if (text === undefined) return 'nothing';
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}

function readNode(
  value: unknown,
  field: string,
  above: Split['split'] | null,
  depth: number,
): LayoutNode {
  if (depth === 0) throw new LayoutError(field, `is more than ${kDeepest} levels deep`);
  const fields = checkFields(value, field, ['tabs', 'active', 'split', 'parts']);
  if ('tabs' in fields) return readTabs(fields, field);
  const { split, parts } = checkFields(value, field, ['split', 'parts']);
  if (split !== 'row' && split !== 'column') {
    throw new LayoutError(`${field}.split`, `must be "row" or "column", not ${quoted(split)}`);
  }
  if (split === above) {
    throw new LayoutError(`${field}.split`, `a ${split} must not lie directly in a ${split}`);
  }
  if (!Array.isArray(parts) || parts.length === 0 || parts.length > kMostParts) {
    throw new LayoutError(`${field}.parts`, `must be a list of 1 to ${kMostParts} parts`);
  }
  const read = parts.map((part: unknown, i) =>
    readPart(part, `${field}.parts[${i}]`, split, depth - 1),
  );
  return { split, parts: read };
}

function readTabs(value: unknown, field: string): Tabs {
  const { tabs, active } = checkFields(value, field, ['tabs', 'active']);
  if (!Array.isArray(tabs) || tabs.length === 0) {
    throw new LayoutError(`${field}.tabs`, 'must be a list of names of panels');
  }
  const names = tabs.map((name: unknown, i) => {
    if (isPanelName(name)) return name;
    throw new LayoutError(`${field}.tabs[${i}]`, `there is no panel ${quoted(name)}`);
  });
  const front = names.find((name) => name === active);
  if (front === undefined) {
    throw new LayoutError(`${field}.active`, `must be one of the tabs, not ${quoted(active)}`);
  }
  return { tabs: names, active: front };
}

function readPart(value: unknown, field: string, split: Split['split'], depth: number): Part {
  const { size, node } = checkFields(value, field, ['size', 'node']);
  if (typeof size !== 'number' || !Number.isFinite(size) || size <= 0) {
    throw new LayoutError(`${field}.size`, `must be a number above 0, not ${quoted(size)}`);
  }
  return { size, node: readNode(node, `${field}.node`, split, depth) };
}

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
export function frontPanels(node: LayoutNode): PanelName[] {
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

/** @return null for anything that is not an arrangement in which every panel occurs once */
export function readLayout(value: unknown): LayoutNode | null {
  const node = readNode(value, null, kDeepest);
  if (node === null) return null;
  const panels = panelsOf(node);
  return new Set(panels).size === panels.length ? node : null;
}

function readNode(value: unknown, above: Split['split'] | null, depth: number): LayoutNode | null {
  if (typeof value !== 'object' || value === null || depth === 0) return null;
  const { tabs, active, split, parts } = value as Record<string, unknown>;
  if (Array.isArray(tabs)) return readTabs(tabs, active);
  if ((split !== 'row' && split !== 'column') || split === above) return null;
  if (!Array.isArray(parts) || parts.length === 0 || parts.length > kMostParts) return null;
  const read: Part[] = [];
  for (const part of parts as unknown[]) {
    const one = readPart(part, split, depth - 1);
    if (one === null) return null;
    read.push(one);
  }
  return { split, parts: read };
}

function readTabs(tabs: unknown[], active: unknown): Tabs | null {
  const names = tabs.filter(isPanelName);
  const front = names.find((name) => name === active);
  return names.length === tabs.length && front !== undefined
    ? { tabs: names, active: front }
    : null;
}

function readPart(value: unknown, split: Split['split'], depth: number): Part | null {
  if (typeof value !== 'object' || value === null) return null;
  const { size, node } = value as Record<string, unknown>;
  if (typeof size !== 'number' || !Number.isFinite(size) || size <= 0) return null;
  const read = readNode(node, split, depth);
  return read === null ? null : { size, node: read };
}

// Own layouts as a JSON file, which a team shares. Files come from anywhere, so every field is checked.
import { kSceneModes, kSceneParts } from '../scene/scene_look';
import { checkFields, checkLayout, LayoutError, quoted } from './layout_tree';
import type { LayoutLook, OwnLayout } from './layouts';
import { kLongestLook, kMostOwn, nameProblem } from './layouts';

const kFormat = 'overfly_layouts';
const kFormatVersion = 1;
const kMost_bytes = 1 << 20;

/** A file to be saved by the browser. */
export interface LayoutFile {
  name: string;
  text: string;
}

export type ReadableFile = Pick<File, 'name' | 'size' | 'text'>;

export function writeLayoutFile(layouts: readonly OwnLayout[]): LayoutFile {
  const [only] = layouts;
  const name = layouts.length === 1 && only !== undefined ? fileNameOf(only.name) : 'overfly';
  const document = {
    format: kFormat,
    format_version: kFormatVersion,
    layouts: layouts.map(({ name: title, tree, look }) => ({
      name: title,
      panels: tree,
      ...(look === null ? {} : { look: lookDocument(look) }),
    })),
  };
  return { name: `${name}.layouts.json`, text: `${JSON.stringify(document, null, 2)}\n` };
}

/** Errors: LayoutError, which names the field. */
export async function readLayoutFile(file: ReadableFile): Promise<OwnLayout[]> {
  if (file.size > kMost_bytes) {
    throw new LayoutError('size', `${file.size} bytes: must be at most ${kMost_bytes}`);
  }
  return readLayoutText(await file.text());
}

export function readLayoutText(text: string): OwnLayout[] {
  const document = parsed(text);
  if (!isLayoutDocument(document)) {
    throw new LayoutError('format', `must be "${kFormat}": this is no file of layouts`);
  }
  // A later version may have fields that this one does not know.
  const version = document['format_version'];
  if (version !== kFormatVersion) {
    throw new LayoutError('format_version', `must be ${kFormatVersion}, not ${quoted(version)}`);
  }
  const { layouts } = checkFields(document, 'file', ['format', 'format_version', 'layouts']);
  if (!Array.isArray(layouts) || layouts.length === 0 || layouts.length > kMostOwn) {
    throw new LayoutError('layouts', `must be a list of 1 to ${kMostOwn} layouts`);
  }
  const read = layouts.map((layout: unknown, i) => readOwn(layout, `layouts[${i}]`));
  for (const [i, { name }] of read.entries()) {
    const first = read.findIndex((other) => other.name === name);
    if (first === i) continue;
    throw new LayoutError(`layouts[${i}].name`, `is the same as that of layouts[${first}]`);
  }
  return read;
}

/** Whether a dropped file is one of layouts, also a damaged one. */
export async function isLayoutFile(file: File): Promise<boolean> {
  if (!file.name.toLowerCase().endsWith('.json')) return false;
  // A folder cannot be read.
  const begin = await file
    .slice(0, 1000)
    .text()
    .catch(() => '');
  return begin.includes(`"${kFormat}"`);
}

function isLayoutDocument(value: unknown): value is Record<string, unknown> {
  return (
    typeof value === 'object' && value !== null && 'format' in value && value.format === kFormat
  );
}

function readOwn(value: unknown, field: string): OwnLayout {
  const { name, panels, look } = checkFields(value, field, ['name', 'panels', 'look']);
  if (typeof name !== 'string') throw new LayoutError(`${field}.name`, 'must be a text');
  const title = name.trim();
  const problem = nameProblem(title);
  if (problem !== null) throw new LayoutError(`${field}.name`, problem);
  return {
    name: title,
    tree: checkLayout(panels, `${field}.panels`),
    look: look === undefined ? null : readLook(look, `${field}.look`),
  };
}

function lookDocument({ view, show, sideBySide }: LayoutLook) {
  return { view, show, side_by_side: sideBySide };
}

function readLook(value: unknown, field: string): LayoutLook {
  const look = checkFields(value, field, ['view', 'show', 'side_by_side']);
  const sideBySide = look['side_by_side'];
  if (typeof sideBySide !== 'boolean') {
    throw new LayoutError(`${field}.side_by_side`, 'must be true or false');
  }
  const view = readText(look['view'], `${field}.view`);
  if (view !== '' && !isView(view)) {
    throw new LayoutError(`${field}.view`, `${quoted(view)} is no viewpoint of the 3D view`);
  }
  const show = readText(look['show'], `${field}.show`);
  const parts = show === '' || show === 'none' ? [] : show.split(',');
  const unknown = parts.find((name) => !kSceneParts.some(({ part }) => part === name));
  if (unknown !== undefined) {
    throw new LayoutError(`${field}.show`, `the 3D view has no part ${quoted(unknown)}`);
  }
  return { view, show, sideBySide };
}

function readText(value: unknown, field: string): string {
  if (typeof value === 'string' && value.length <= kLongestLook) return value;
  throw new LayoutError(field, `must be a text of at most ${kLongestLook} characters`);
}

/** As scene/scene_look.ts writes it. */
function isView(text: string): boolean {
  const [name, ...rest] = text.split(',');
  const mode = kSceneModes.find((known) => known.mode === name)?.mode;
  if (mode === undefined) return false;
  if (mode !== 'free' && rest.at(-1) === 'fixed') rest.pop();
  const finite = rest.every((number) => number.trim() !== '' && Number.isFinite(Number(number)));
  return finite && rest.length === (mode === 'free' ? 5 : 3);
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch (error) {
    throw new LayoutError('file', `is not JSON (${error instanceof Error ? error.message : ''})`);
  }
}

/** Letters and digits of any language stay. */
function fileNameOf(title: string): string {
  const name = title.replaceAll(/[^\p{L}\p{N}]+/gu, '_').replaceAll(/^_|_$/g, '');
  return name === '' ? 'layout' : name;
}

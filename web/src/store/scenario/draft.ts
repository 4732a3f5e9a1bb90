// The scenario as the viewer has changed it: the server's document and the edited sections as text.
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import { isObject } from './schema_node';

/** Texts of edited sections by name; an empty text removes the section. */
export type Edits = ReadonlyMap<string, string>;

/** The edits are not those of the document that the server has now. */
export const kChangedMeanwhile: FieldError = {
  field: '',
  message:
    'The scenario was changed on the server meanwhile. Take your changes back, or save them under another name.',
};

/** What was to be done with the scenario that was shown before is not done. */
export const kChosenMeanwhile = 'another choice was made in Launch meanwhile.';

/**
 * What has become of the shown scenario: `changed` on the server by somebody else, or `left` here for
 * another one.
 */
export type ShownScenario = 'same' | 'changed' | 'left';

/** The changed document; sections that are not JSON stay as they were, and are errors. */
export function draftOf(
  base: JsonObject,
  edits: Edits,
): { document: JsonObject; errors: FieldError[] } {
  const document = { ...base };
  const errors: FieldError[] = [];
  for (const [section, text] of edits) {
    if (text.trim() === '') {
      Reflect.deleteProperty(document, section);
      continue;
    }
    try {
      document[section] = JSON.parse(text) as Json;
    } catch (error) {
      errors.push({ field: section, message: `is not JSON: ${(error as Error).message}` });
    }
  }
  return { document, errors };
}

/** Text of a document's section, for editing. */
export function sectionText(document: JsonObject, section: string): string {
  const value = document[section];
  return value === undefined ? '' : JSON.stringify(value, null, 2);
}

/** The edits with the section of `path` as it is in a changed document. */
export function editsWith(
  base: JsonObject,
  edits: Edits,
  changed: JsonObject,
  path: string,
): Map<string, string> {
  const [section = ''] = path.split('.');
  return editsWithText(base, edits, section, sectionText(changed, section));
}

/** The edits with another text of a section; a text that changes nothing is no edit. */
export function editsWithText(
  base: JsonObject,
  edits: Edits,
  section: string,
  text: string,
): Map<string, string> {
  const next = new Map(edits);
  if (text === sectionText(base, section)) next.delete(section);
  else next.set(section, text);
  return next;
}

/** Value at a dotted path; parts that are numbers count the entries of lists. */
export function valueIn(document: Json | undefined, path: string): Json | undefined {
  let value = document;
  for (const part of path.split('.')) {
    if (Array.isArray(value)) value = value[Number(part)];
    else if (isObject(value)) value = value[part];
    else return undefined;
  }
  return value;
}

/** A document with another value at a path; undefined removes it. Objects on the way are made. */
export function withValue(document: JsonObject, path: string, value: Json | undefined): JsonObject {
  return changedAt(document, path.split('.'), value) as JsonObject;
}

function changedAt(place: Json | undefined, parts: readonly string[], value: Json | undefined) {
  const [part = '', ...rest] = parts;
  if (Array.isArray(place)) {
    const list = [...place];
    const i = Number(part);
    if (rest.length > 0) list[i] = changedAt(list[i], rest, value);
    else if (value === undefined) list.splice(i, 1);
    else list[i] = value;
    return list;
  }
  const object: JsonObject = isObject(place) ? { ...place } : {};
  if (rest.length > 0) object[part] = changedAt(object[part], rest, value);
  else if (value === undefined) Reflect.deleteProperty(object, part);
  else object[part] = value;
  return object as Json;
}

/**
 * What the server has to put into the scenario's file: value by dotted path. Lists, and objects of
 * which something was removed, are given as a whole; null = a whole section was removed.
 */
export function overridesBetween(
  base: JsonObject,
  changed: JsonObject,
): Record<string, Json> | null {
  if (Object.keys(base).some((name) => !(name in changed))) return null;
  const overrides: Record<string, Json> = {};
  collect(base, changed, '', overrides);
  return overrides;
}

function collect(
  base: JsonObject,
  changed: JsonObject,
  path: string,
  overrides: Record<string, Json>,
): void {
  for (const [name, value] of Object.entries(changed)) {
    const before = base[name];
    if (sameJson(before, value)) continue;
    const place = path + name;
    if (isObject(before) && isObject(value) && canBeSplit(before, value)) {
      collect(before, value, `${place}.`, overrides);
    } else {
      overrides[place] = value;
    }
  }
}

function canBeSplit(before: JsonObject, value: JsonObject): boolean {
  return (
    Object.keys(before).every((name) => name in value) &&
    Object.keys(value).every((name) => !name.includes('.'))
  );
}

export function sameJson(a: Json | undefined, b: Json | undefined): boolean {
  if (a === b) return true;
  if (Array.isArray(a) && Array.isArray(b)) {
    return a.length === b.length && a.every((entry, i) => sameJson(entry, b[i]));
  }
  if (!isObject(a) || !isObject(b)) return false;
  const names = Object.keys(a);
  return (
    names.length === Object.keys(b).length &&
    names.every((name) => name in b && sameJson(a[name], b[name]))
  );
}

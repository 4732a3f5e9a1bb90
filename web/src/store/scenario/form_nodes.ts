// What the editor's form of a section consists of: made of the schema and the section's value.
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import { labelOf, unitOf } from './field_names';
import {
  branchesOf,
  isObject,
  limitsOf,
  meantBranches,
  nodeFor,
  objectAt,
  objectOf,
  requiredOf,
  textOf,
} from './schema_node';
import { generalFields, kGeneral } from './sections';

interface Place {
  /** Dotted, from the top of the document. */
  path: string;
  /** Of its elements: the path, but of a variant's value another one. */
  id: string;
  label: string;
  hint: string;
}

/** One value. */
export interface ValueNode extends Place {
  kind: 'value';
  input: 'number' | 'text' | 'choice' | 'switch' | 'numbers';
  unit: string;
  choices: readonly string[];
  /** '' = not given. */
  text: string;
  /** What holds if nothing is given; '' = not known. */
  usual: string;
  required: boolean;
}

export interface GroupNode extends Place {
  kind: 'group';
  /** It cannot be removed. */
  required: boolean;
  /** Not given, and can be added. */
  absent: boolean;
  /** What adding it gives. */
  fresh: Json;
  children: FormNode[];
}

export interface ListNode extends Place {
  kind: 'list';
  entries: { path: string; title: string; children: FormNode[] }[];
  full: boolean;
  fresh: Json;
}

/** One of several forms. */
export interface VariantNode extends Place {
  kind: 'variant';
  choices: readonly { label: string; fresh: Json }[];
  /** -1 = none. */
  chosen: number;
  required: boolean;
  children: FormNode[];
}

/** What has no fields that are known before: edited as JSON. */
export interface TextNode extends Place {
  kind: 'json';
  text: string;
}

export type FormNode = ValueNode | GroupNode | ListNode | VariantNode | TextNode;

/** First in their forms; the others follow in the schema's order. */
const kFirst = [
  'name',
  'type',
  'width_px',
  'height_px',
  'rate_hz',
  'fov_deg',
  'fov_axis',
  'distortion',
];
const kGeneralFirst = ['title', 'description', 'seed', 'start_s', 'duration_s', 'pacing'];

/** The form of a section. */
export function formOf(schema: JsonObject, section: string, document: JsonObject): FormNode[] {
  const properties = objectAt(schema, 'properties');
  if (section === kGeneral) {
    const required = requiredOf(schema);
    return inOrder(generalFields(schema), kGeneralFirst).map((name) =>
      makeNode(schema, properties[name], document[name], name, required.includes(name)),
    );
  }
  const required = requiredOf(schema).includes(section);
  return [makeNode(schema, properties[section], document[section], section, required)];
}

function makeNode(
  root: JsonObject,
  raw: Json | undefined,
  value: Json | undefined,
  path: string,
  required: boolean,
): FormNode {
  const node = nodeFor(root, raw, value);
  const name = path.split('.').at(-1) ?? '';
  const place = { path, id: path, label: labelOf(name), hint: textOf(node['description']) };
  const { type } = node;
  if (Array.isArray(node['enum'])) {
    const choices = node['enum'].map(String);
    return valueNode(node, place, 'choice', value, required, choices);
  }
  if (type === 'boolean') return valueNode(node, place, 'switch', value, required);
  if (type === 'number' || type === 'integer') {
    return valueNode(node, place, 'number', value, required);
  }
  if (type === 'string') return valueNode(node, place, 'text', value, required);
  if (type === 'array') return listNode(root, node, place, value, required);
  if (type === 'object' && 'properties' in node) {
    return groupNode(root, node, place, value, required);
  }
  const branches = branchesOf(root, node);
  if (branches.length > 0) return variantNode(root, branches, place, value, required);
  return { ...place, kind: 'json', text: jsonText(value) };
}

function groupNode(
  root: JsonObject,
  node: JsonObject,
  place: Place,
  value: Json | undefined,
  required: boolean,
): GroupNode {
  const usual = node['default'];
  // Not to give it is the same as giving nothing in it: its fields are always shown.
  const open = isObject(usual) && Object.keys(usual).length === 0;
  const absent = !isObject(value) && !open;
  const empty = Object.keys(objectAt(node, 'properties')).length === 0;
  return {
    ...place,
    kind: 'group',
    hint: empty ? `${place.hint} This type has no parameters.`.trim() : place.hint,
    required: required || open,
    absent,
    fresh: freshValue(root, node) ?? {},
    children: absent ? [] : childrenOf(root, node, objectOf(value), place.path),
  };
}

function childrenOf(root: JsonObject, node: JsonObject, value: JsonObject, path: string) {
  const properties = objectAt(node, 'properties');
  const required = requiredOf(node);
  // What does not belong to the type is shown only where it stands and has to go.
  const names = Object.keys(properties).filter(
    (name) => properties[name] !== false || name in value,
  );
  return inOrder(names, kFirst).map((name) =>
    makeNode(root, properties[name], value[name], `${path}.${name}`, required.includes(name)),
  );
}

function valueNode(
  node: JsonObject,
  place: Place,
  input: ValueNode['input'],
  value: Json | undefined,
  required: boolean,
  choices: readonly string[] = [],
): ValueNode {
  const limits = limitsOf(node).text;
  const usual = node['default'];
  return {
    ...place,
    kind: 'value',
    input,
    unit: unitOf(place.path),
    choices,
    hint: [limits, place.hint].filter((text) => text !== '').join(' · '),
    text: inputText(value),
    usual: usual === undefined ? '' : inputText(usual),
    required,
  };
}

function listNode(
  root: JsonObject,
  node: JsonObject,
  place: Place,
  value: Json | undefined,
  required: boolean,
): FormNode {
  const { items, maxItems } = node;
  const item = nodeFor(root, items, undefined);
  if (item['type'] === 'number' || item['type'] === 'integer') {
    return valueNode(node, place, 'numbers', value, required);
  }
  if (item['type'] !== 'object') return { ...place, kind: 'json', text: jsonText(value) };
  const list = Array.isArray(value) ? value : [];
  return {
    ...place,
    kind: 'list',
    entries: list.map((entry, i) => {
      const path = `${place.path}.${i}`;
      const object = objectOf(entry);
      const title = object['name'] ?? object['kind'] ?? object['file'];
      return {
        path,
        title: typeof title === 'string' && title !== '' ? title : `${i + 1}`,
        children: childrenOf(root, nodeFor(root, items, object), object, path),
      };
    }),
    full: typeof maxItems === 'number' && list.length >= maxItems,
    fresh: freshValue(root, item) ?? {},
  };
}

function variantNode(
  root: JsonObject,
  branches: JsonObject[],
  place: Place,
  value: Json | undefined,
  required: boolean,
): VariantNode {
  const meant = value === undefined ? [] : meantBranches(branches, value);
  const chosen = meant[0] ?? -1;
  const branch = branches[chosen];
  return {
    ...place,
    kind: 'variant',
    choices: branches.map((one) => ({
      label: textOf(one['title']).replaceAll('"', ''),
      fresh: freshValue(root, one) ?? '',
    })),
    chosen,
    required,
    children: branch === undefined ? [] : variantChildren(root, branch, value, place),
  };
}

/** A constant needs no field; an object shows its fields, without a frame of its own. */
function variantChildren(
  root: JsonObject,
  branch: JsonObject,
  value: Json | undefined,
  place: Place,
): FormNode[] {
  if ('const' in branch) return [];
  if (!isObject(value)) {
    return [{ ...makeNode(root, branch, value, place.path, true), id: `${place.path}.value` }];
  }
  return childrenOf(root, branch, value, place.path);
}

/** A beginning; what has to be given and has no usual value is left to be filled in. */
function freshValue(root: JsonObject, raw: Json | undefined): Json | undefined {
  const node = nodeFor(root, raw, undefined);
  if ('const' in node) return node['const'];
  if (node['default'] !== undefined) return node['default'];
  const choices = node['enum'];
  if (Array.isArray(choices)) return choices[0];
  const [first] = branchesOf(root, node);
  if (first !== undefined && !('properties' in node)) return freshValue(root, first);
  if (node['type'] === 'boolean') return false;
  if (node['type'] !== 'object') return undefined;
  const properties = objectAt(node, 'properties');
  const value: JsonObject = {};
  for (const name of requiredOf(node)) {
    const inner = freshValue(root, properties[name]);
    if (inner !== undefined) value[name] = inner;
  }
  return value;
}

/** What was typed, as a value; text that is none stays text, so that its error can be shown. */
export function valueOfInput(input: ValueNode['input'], text: string): Json | undefined {
  const typed = text.trim();
  if (typed === '') return undefined;
  if (input === 'switch') return typed === 'true';
  if (input === 'number') return numberOf(typed);
  if (input === 'numbers') return typed.split(/[\s,;]+/).map(numberOf);
  return text;
}

/** JSON that was typed; text that is none stays text. */
export function valueOfJson(text: string): Json | undefined {
  if (text.trim() === '') return undefined;
  try {
    return JSON.parse(text) as Json;
  } catch {
    return text;
  }
}

/** The errors that a form shows at each path: at the field itself, or at the one that contains it. */
export function errorsByPath(
  paths: readonly string[],
  errors: readonly FieldError[],
): Map<string, string> {
  const found = new Map<string, string>();
  for (const { field, message } of errors) {
    const owners = paths.filter((path) => field === path || field.startsWith(`${path}.`));
    const [owner] = owners.sort((a, b) => b.length - a.length);
    if (owner === undefined) continue;
    const within = field === owner ? '' : `${field.slice(owner.length + 1)}: `;
    found.set(owner, [found.get(owner), within + message].filter(Boolean).join(' · '));
  }
  return found;
}

function numberOf(text: string): Json {
  const value = Number(text);
  return Number.isFinite(value) ? value : text;
}

function inputText(value: Json | undefined): string {
  if (value === undefined) return '';
  if (Array.isArray(value)) return value.map(inputText).join(', ');
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}

function jsonText(value: Json | undefined): string {
  if (value === undefined) return '';
  return typeof value === 'string' ? value : JSON.stringify(value, null, 2);
}

function inOrder(names: readonly string[], first: readonly string[]): string[] {
  return [
    ...first.filter((name) => names.includes(name)),
    ...names.filter((name) => !first.includes(name)),
  ];
}

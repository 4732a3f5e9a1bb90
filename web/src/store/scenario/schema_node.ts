// Nodes of a JSON schema: references followed, and conditions on the value applied.
import type { Json, JsonObject } from '../../protocol/rest_types';

export function objectOf(value: Json | undefined): JsonObject {
  return isObject(value) ? value : {};
}

export function objectAt(node: JsonObject, name: string): JsonObject {
  return objectOf(node[name]);
}

/** '' for what is no text. */
export function textOf(value: Json | undefined): string {
  return typeof value === 'string' ? value : '';
}

export function isObject(value: Json | undefined): value is JsonObject {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

/**
 * The node that describes a value: its reference followed, its conditions (`allOf` of `if`, `then`)
 * applied. What stands next to a reference, such as a description, precedes what it names.
 */
export function nodeFor(root: JsonObject, raw: Json | undefined, value: Json | undefined) {
  const node = resolved(root, raw);
  const conditions = node['allOf'];
  if (!Array.isArray(conditions)) return node;
  const properties = { ...objectAt(node, 'properties') };
  for (const condition of conditions.map(objectOf)) {
    if (!holds(objectAt(condition, 'if'), value)) continue;
    Object.assign(properties, objectAt(objectAt(condition, 'then'), 'properties'));
  }
  return { ...node, properties };
}

function resolved(root: JsonObject, raw: Json | undefined): JsonObject {
  const node = objectOf(raw);
  const reference = node['$ref'];
  if (typeof reference !== 'string') return node;
  return { ...objectOf(objectAt(root, '$defs')[reference.replace('#/$defs/', '')]), ...node };
}

/** Conditions say which constants, or which of several, the fields of an object have. */
function holds(condition: JsonObject, value: Json | undefined): boolean {
  return Object.entries(objectAt(condition, 'properties')).every(([name, raw]) => {
    const actual = objectOf(value)[name];
    const wanted = objectOf(raw);
    if ('const' in wanted) return actual === wanted['const'];
    const choices = wanted['enum'];
    return Array.isArray(choices) && actual !== undefined && choices.includes(actual);
  });
}

/** The alternatives of a node (`oneOf`); none = it has none. */
export function branchesOf(root: JsonObject, node: JsonObject): JsonObject[] {
  const branches = node['oneOf'];
  return Array.isArray(branches) ? branches.map((branch) => resolved(root, branch)) : [];
}

/** Which alternatives a value is meant to be: by its type, its constant and its required fields. */
export function meantBranches(branches: readonly JsonObject[], value: Json): number[] {
  return branches.flatMap((branch, i) => (isMeant(branch, value) ? [i] : []));
}

function isMeant(branch: JsonObject, value: Json): boolean {
  if ('const' in branch) return value === branch['const'];
  const type = branch['type'];
  if (typeof type === 'string' && !hasType(value, type)) return false;
  const required = branch['required'];
  return !Array.isArray(required) || required.every((name) => textOf(name) in objectOf(value));
}

export function hasType(value: Json, type: string): boolean {
  if (type === 'integer') return Number.isInteger(value);
  if (type === 'array') return Array.isArray(value);
  if (type === 'null') return value === null;
  if (type === 'object') return isObject(value);
  return typeof value === type;
}

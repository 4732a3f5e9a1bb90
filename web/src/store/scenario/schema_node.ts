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
  return requiredOf(branch).every((name) => Object.hasOwn(objectOf(value), name));
}

/** Names of the fields that an object must have. */
export function requiredOf(node: JsonObject): string[] {
  const { required } = node;
  return Array.isArray(required) ? required.map(String) : [];
}

/** Limits of a number, and how they are written. */
export function limitsOf(node: JsonObject) {
  const limit = (name: string) => {
    const value = node[name];
    return typeof value === 'number' ? value : undefined;
  };
  const lowOpen = limit('minimum') === undefined;
  const highOpen = limit('maximum') === undefined;
  const low = limit('minimum') ?? limit('exclusiveMinimum') ?? -Infinity;
  const high = limit('maximum') ?? limit('exclusiveMaximum') ?? Infinity;
  let text = '';
  if (Number.isFinite(low) && Number.isFinite(high)) {
    text = `in ${lowOpen ? '(' : '['}${low}, ${high}${highOpen ? ')' : ']'}`;
  } else if (Number.isFinite(low)) {
    text = lowOpen ? `above ${low}` : `at least ${low}`;
  } else if (Number.isFinite(high)) {
    text = highOpen ? `below ${high}` : `at most ${high}`;
  }
  return { low, high, lowOpen, highOpen, text };
}

export function hasType(value: Json, type: string): boolean {
  if (type === 'integer') return Number.isInteger(value);
  if (type === 'array') return Array.isArray(value);
  if (type === 'null') return value === null;
  if (type === 'object') return isObject(value);
  return typeof value === type;
}

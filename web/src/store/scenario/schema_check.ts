// Checks a scenario against the server's JSON schema while it is typed. What the schema cannot
// express is checked by the server.
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import {
  branchesOf,
  hasType,
  isObject,
  limitsOf,
  meantBranches,
  nodeFor,
  objectAt,
  objectOf,
  requiredOf,
  textOf,
} from './schema_node';

const kTypes: Record<string, string> = {
  integer: 'an integer',
  number: 'a number',
  string: 'text',
  boolean: 'true or false',
  array: 'a list',
  object: 'an object',
  null: 'null',
};

/** Errors of a whole document; paths begin with the names of its sections. */
export function documentErrors(schema: JsonObject, document: JsonObject): FieldError[] {
  const errors: FieldError[] = [];
  checkObject(schema, schema, document, '', errors);
  return errors;
}

function check(
  root: JsonObject,
  raw: Json | undefined,
  value: Json,
  path: string,
  errors: FieldError[],
): void {
  const add = (message: string) => void errors.push({ field: path, message });
  if (raw === false) {
    add('does not belong to this type');
    return;
  }
  const node = nodeFor(root, raw, value);
  const { type } = node;
  if (typeof type === 'string' && !hasType(value, type)) {
    add(`must be ${kTypes[type] ?? type}`);
    return;
  }
  if ('const' in node && value !== node['const']) add(`must be ${JSON.stringify(node['const'])}`);
  const choices = node['enum'];
  if (Array.isArray(choices) && !choices.includes(value)) {
    add(`must be one of ${choices.map((choice) => JSON.stringify(choice)).join(', ')}`);
  }
  checkBranches(root, node, value, path, errors);
  if (typeof value === 'number') checkNumber(node, value, add);
  if (typeof value === 'string') checkText(node, value, add);
  if (Array.isArray(value)) checkArray(root, node, value, path, errors);
  else if (isObject(value)) checkObject(root, node, value, path, errors);
}

/** Exactly one alternative must hold; the errors of the one that is meant are shown. */
function checkBranches(
  root: JsonObject,
  node: JsonObject,
  value: Json,
  path: string,
  errors: FieldError[],
): void {
  const branches = branchesOf(root, node);
  if (branches.length === 0) return;
  const meant = meantBranches(branches, value);
  if (meant.length !== 1) {
    const titles = branches.map(({ title }) => textOf(title)).join(', ');
    errors.push({ field: path, message: `must be exactly one of ${titles}` });
    return;
  }
  check(root, branches[meant[0] ?? 0], value, path, errors);
}

function checkNumber(node: JsonObject, value: number, add: (message: string) => void): void {
  const limits = limitsOf(node);
  const holds =
    value >= limits.low &&
    value <= limits.high &&
    !(limits.lowOpen && value === limits.low) &&
    !(limits.highOpen && value === limits.high);
  if (!holds) add(`must be ${limits.text}`);
}

function checkText(node: JsonObject, value: string, add: (message: string) => void): void {
  const { pattern, minLength, maxLength } = node;
  if (typeof minLength === 'number' && value.length < minLength) {
    add(minLength === 1 ? 'must not be empty' : `must have at least ${minLength} characters`);
    return;
  }
  if (typeof maxLength === 'number' && value.length > maxLength) {
    add(`must have at most ${maxLength} characters`);
  }
  if (typeof pattern === 'string' && !new RegExp(pattern, 'u').test(value)) {
    add(`must match ${pattern}`);
  }
}

function checkArray(
  root: JsonObject,
  node: JsonObject,
  value: Json[],
  path: string,
  errors: FieldError[],
): void {
  const add = (message: string) => void errors.push({ field: path, message });
  const { minItems, maxItems, items } = node;
  if (typeof minItems === 'number' && value.length < minItems) {
    add(`must have at least ${minItems} entries`);
  }
  if (typeof maxItems === 'number' && value.length > maxItems) {
    add(`must have at most ${maxItems} entries`);
  }
  if (items !== undefined) {
    value.forEach((entry, i) => check(root, items, entry, `${path}.${i}`, errors));
  }
}

function checkObject(
  root: JsonObject,
  node: JsonObject,
  value: JsonObject,
  path: string,
  errors: FieldError[],
): void {
  const place = (name: string) => (path === '' ? name : `${path}.${name}`);
  const add = (name: string, message: string) => void errors.push({ field: place(name), message });
  const properties = objectAt(node, 'properties');
  const { maxProperties, additionalProperties } = node;
  for (const name of requiredOf(node)) {
    if (!Object.hasOwn(value, name)) add(name, 'is required');
  }
  if (typeof maxProperties === 'number' && Object.keys(value).length > maxProperties) {
    errors.push({ field: path, message: `must have at most ${maxProperties} fields` });
  }
  for (const [name, needed] of Object.entries(objectAt(node, 'dependentRequired'))) {
    if (!Object.hasOwn(value, name) || !Array.isArray(needed)) continue;
    for (const other of needed.map(String)) {
      if (!Object.hasOwn(value, other)) add(other, `is required with ${name}`);
    }
  }
  for (const [name, entry] of Object.entries(value)) {
    if (Object.hasOwn(properties, name)) check(root, properties[name], entry, place(name), errors);
    else if (additionalProperties === false) add(name, 'is not a known field');
    else if (Object.keys(objectOf(additionalProperties)).length > 0) {
      check(root, additionalProperties, entry, place(name), errors);
    }
  }
}

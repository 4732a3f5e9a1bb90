// Checks a scenario's sections against the server's JSON schema while they are typed. Rules that
// the schema cannot express are checked by the server at launch.
import type { FieldError } from '../protocol/field_errors';
import type { Json, JsonObject } from '../protocol/rest_types';

/** Top-level sections offered for editing as JSON, in the schema's order. */
export function sectionsOf(schema: JsonObject): string[] {
  return Object.entries(objectAt(schema, 'properties'))
    .filter(([name, node]) => {
      const type = objectOf(resolved(schema, node))['type'];
      return (type === 'object' || type === 'array') && name !== 'estimators';
    })
    .map(([name]) => name);
}

export interface FieldNote {
  name: string;
  what: string;
  description: string;
}

/** The fields that a section may have, for display; for a list, those of its entries. */
export function fieldNotes(schema: JsonObject, section: string): FieldNote[] {
  const node = sectionNode(schema, section);
  const inner = objectOf(resolved(schema, node['items'] ?? node));
  return Object.entries(objectAt(inner, 'properties')).map(([name, value]) => {
    const field = objectOf(resolved(schema, value));
    const description = field['description'];
    return {
      name,
      what: kindOf(field),
      description: typeof description === 'string' ? description : '',
    };
  });
}

export function sectionDescription(schema: JsonObject, section: string): string {
  const description = sectionNode(schema, section)['description'];
  return typeof description === 'string' ? description : '';
}

/** Errors in a section's text; empty text leaves the section as in the scenario. */
export function sectionErrors(schema: JsonObject, section: string, text: string): FieldError[] {
  if (text.trim() === '') return [];
  let value: Json;
  try {
    value = JSON.parse(text) as Json;
  } catch (error) {
    return [{ field: section, message: `is not JSON: ${(error as Error).message}` }];
  }
  const errors: FieldError[] = [];
  check(schema, sectionNode(schema, section), value, section, errors);
  return errors;
}

/** The edited sections as overrides. @pre they have no errors */
export function sectionOverrides(edits: ReadonlyMap<string, string>): Record<string, Json> {
  const overrides: Record<string, Json> = {};
  for (const [section, text] of edits) {
    if (text.trim() !== '') overrides[section] = JSON.parse(text) as Json;
  }
  return overrides;
}

/** Text of a document's section, for editing. */
export function sectionText(document: JsonObject, section: string): string {
  const value = document[section];
  return value === undefined ? '' : JSON.stringify(value, null, 2);
}

function check(root: JsonObject, raw: Json, value: Json, path: string, errors: FieldError[]): void {
  const node = objectOf(resolved(root, raw));
  const add = (message: string) => void errors.push({ field: path, message });
  const type = node['type'];
  if (typeof type === 'string' && !hasType(value, type)) {
    add(`must be ${type === 'integer' ? 'an integer' : `of type ${type}`}`);
    return;
  }
  const choices = node['enum'];
  if (Array.isArray(choices) && !choices.includes(value)) {
    add(`must be one of ${choices.map((choice) => JSON.stringify(choice)).join(', ')}`);
  }
  if (typeof value === 'number') checkNumber(node, value, add);
  if (typeof value === 'string') {
    const pattern = node['pattern'];
    if (typeof pattern === 'string' && !new RegExp(pattern, 'u').test(value)) {
      add(`must match ${pattern}`);
    }
  }
  if (Array.isArray(value)) checkArray(root, node, value, path, errors);
  else if (typeof value === 'object' && value !== null) {
    checkObject(root, node, value, path, errors);
  }
}

function checkNumber(node: JsonObject, value: number, add: (message: string) => void): void {
  const limit = (name: string) => (typeof node[name] === 'number' ? node[name] : undefined);
  const [low, high] = [limit('minimum'), limit('maximum')];
  const [above, below] = [limit('exclusiveMinimum'), limit('exclusiveMaximum')];
  if (low !== undefined && value < low) add(`must be at least ${low}`);
  if (high !== undefined && value > high) add(`must be at most ${high}`);
  if (above !== undefined && value <= above) add(`must be above ${above}`);
  if (below !== undefined && value >= below) add(`must be below ${below}`);
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
  const properties = objectAt(node, 'properties');
  const { required } = node;
  for (const name of Array.isArray(required) ? required : []) {
    if (typeof name === 'string' && !(name in value)) {
      errors.push({ field: `${path}.${name}`, message: 'is required' });
    }
  }
  for (const [name, entry] of Object.entries(value)) {
    const property = properties[name];
    if (property !== undefined) check(root, property, entry, `${path}.${name}`, errors);
    else if (node['additionalProperties'] === false) {
      errors.push({ field: `${path}.${name}`, message: 'is not a known field' });
    }
  }
}

function hasType(value: Json, type: string): boolean {
  if (type === 'integer') return Number.isInteger(value);
  if (type === 'array') return Array.isArray(value);
  if (type === 'null') return value === null;
  if (type === 'object') {
    return typeof value === 'object' && value !== null && !Array.isArray(value);
  }
  return typeof value === type;
}

function sectionNode(schema: JsonObject, section: string): JsonObject {
  const raw = objectOf(objectAt(schema, 'properties')[section]);
  // A description next to the reference describes the section better than the definition's own.
  return { ...objectOf(resolved(schema, raw)), ...raw };
}

/** Follows `$ref` into `$defs`. */
function resolved(root: JsonObject, node: Json | undefined): Json {
  const reference = objectOf(node)['$ref'];
  if (typeof reference !== 'string') return node ?? null;
  return objectAt(root, '$defs')[reference.replace('#/$defs/', '')] ?? null;
}

function objectAt(node: JsonObject, name: string): JsonObject {
  return objectOf(node[name]);
}

function objectOf(value: Json | undefined): JsonObject {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? value : {};
}

function kindOf(field: JsonObject): string {
  const choices = field['enum'];
  if (Array.isArray(choices)) return choices.map(String).join(' | ');
  const type = typeof field['type'] === 'string' ? field['type'] : 'any';
  const low = field['minimum'] ?? field['exclusiveMinimum'];
  const high = field['maximum'] ?? field['exclusiveMaximum'];
  if (typeof low === 'number' && typeof high === 'number') {
    const open = field['minimum'] === undefined ? '(' : '[';
    const close = field['maximum'] === undefined ? ')' : ']';
    return `${type} in ${open}${low}, ${high}${close}`;
  }
  return type;
}

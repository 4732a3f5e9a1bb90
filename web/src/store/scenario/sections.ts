// The sections in which a scenario is edited: its single values together, then each of the others.
import type { JsonObject } from '../../protocol/rest_types';
import { branchesOf, nodeFor, objectAt } from './schema_node';

/** The section of the values that are no section of their own. */
export const kGeneral = 'general';

/** Not offered: how the document is written, where its files lie, and the name, asked when it is saved. */
const kHidden = ['$schema', 'format_version', 'data', 'name'];

/** First in the editor, in this order; the others follow in the schema's order. */
const kFirst = [kGeneral, 'flight', 'camera', 'cameras', 'estimators', 'world'];

const kLabels: Record<string, string> = {
  [kGeneral]: 'General',
  cameras: 'Several cameras',
  light: 'Light',
};

/** Sections with more than one value. */
export function sectionsOf(schema: JsonObject): string[] {
  const names = Object.entries(objectAt(schema, 'properties'))
    .filter(([, raw]) => isSection(schema, nodeFor(schema, raw, undefined)))
    .map(([name]) => name);
  const all = [kGeneral, ...names];
  return [
    ...kFirst.filter((name) => all.includes(name)),
    ...all.filter((name) => !kFirst.includes(name)),
  ];
}

/** Names of the single values at the top of a scenario. */
export function generalFields(schema: JsonObject): string[] {
  return Object.entries(objectAt(schema, 'properties'))
    .filter(([name, raw]) => {
      const node = nodeFor(schema, raw, undefined);
      return !kHidden.includes(name) && !isSection(schema, node);
    })
    .map(([name]) => name);
}

function isSection(schema: JsonObject, node: JsonObject): boolean {
  const { type } = node;
  return type === 'object' || type === 'array' || branchesOf(schema, node).length > 0;
}

export function sectionLabel(section: string): string {
  return kLabels[section] ?? section.charAt(0).toUpperCase() + section.slice(1);
}

/** The section that shows an error's field. */
export function sectionOfField(schema: JsonObject, field: string): string {
  const [first = ''] = field.split('.');
  return sectionsOf(schema).includes(first) ? first : kGeneral;
}

import { describe, expect, it } from 'vitest';
import schemaText from '../../../scenarios/scenario.schema.json?raw';
import type { JsonObject } from '../../src/protocol/rest_types';
import {
  fieldNotes,
  sectionErrors,
  sectionOverrides,
  sectionsOf,
  sectionText,
} from '../../src/store/scenario_schema';

const schema = JSON.parse(schemaText) as JsonObject;

const small: JsonObject = {
  properties: {
    lens: { $ref: '#/$defs/lens', description: 'What is before the sensor.' },
    title: { type: 'string' },
    events: {
      type: 'array',
      maxItems: 2,
      items: {
        type: 'object',
        additionalProperties: false,
        required: ['kind'],
        properties: {
          kind: { enum: ['dirt', 'blackout'] },
          at_s: { type: 'number', minimum: 0, exclusiveMaximum: 10, description: 'When.' },
        },
      },
    },
  },
  $defs: { lens: { type: 'object', properties: { k: { type: 'integer' } } } },
};

const texts = (section: string, value: unknown) =>
  sectionErrors(small, section, typeof value === 'string' ? value : JSON.stringify(value)).map(
    ({ field, message }) => `${field}: ${message}`,
  );

describe('sections of a scenario', () => {
  it('are those that hold more than one value', () => {
    expect(sectionsOf(small)).toEqual(['lens', 'events']);
    expect(sectionsOf(schema)).toContain('camera');
    expect(sectionsOf(schema)).not.toContain('seed');
  });

  it('are checked with the path, the limit and the names that exist', () => {
    expect(texts('events', [{ kind: 'dirt', at_s: 3 }])).toEqual([]);
    expect(texts('events', [{ kind: 'mud' }])).toEqual([
      'events.0.kind: must be one of "dirt", "blackout"',
    ]);
    expect(texts('events', [{ at_s: 10, when: 1 }])).toEqual([
      'events.0.kind: is required',
      'events.0.at_s: must be below 10',
      'events.0.when: is not a known field',
    ]);
    expect(texts('events', [{}, {}, {}])[0]).toBe('events: must have at most 2 entries');
    expect(texts('events', {})).toEqual(['events: must be of type array']);
    expect(texts('lens', { k: 1.5 })).toEqual(['lens.k: must be an integer']);
  });

  it('report text that is not JSON, and ignore empty text', () => {
    expect(texts('lens', '{"k": }')[0]).toMatch(/^lens: is not JSON/u);
    expect(texts('lens', '  ')).toEqual([]);
    const edits = new Map([
      ['lens', ''],
      ['events', '[]'],
    ]);
    expect(sectionOverrides(edits)).toEqual({ events: [] });
  });

  it('accept what the schema itself offers as default', () => {
    const properties = schema['properties'] as Record<string, JsonObject>;
    for (const section of sectionsOf(schema)) {
      const value = properties[section]?.['default'];
      if (value === undefined) continue;
      expect(sectionErrors(schema, section, JSON.stringify(value))).toEqual([]);
    }
  });

  it('explain their fields and show what the scenario has', () => {
    expect(fieldNotes(small, 'events')).toEqual([
      { name: 'kind', what: 'dirt | blackout', description: '' },
      { name: 'at_s', what: 'number in [0, 10)', description: 'When.' },
    ]);
    expect(sectionText({ lens: { k: 1 } }, 'lens')).toBe('{\n  "k": 1\n}');
    expect(sectionText({}, 'lens')).toBe('');
  });
});

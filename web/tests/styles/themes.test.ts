// The contrast of the colours as declared in the style sheet.
import { describe, expect, it } from 'vitest';
import { contrast, kSights, seenDistance } from '../support/colour_sight';

const kSheets = import.meta.glob<string>('../../src/styles/*.css', {
  query: '?raw',
  import: 'default',
  eager: true,
});
const kText_AA = 4.5;
/** Of graphics and of the borders of controls. */
const kGraphics_AA = 3;

const themes = readThemes();

/** Text, and the grounds on which it stands. */
const kTextPairs: Readonly<Record<string, readonly string[]>> = {
  text: ['back', 'panel', 'raised', 'field', 'selected'],
  muted: ['back', 'panel', 'raised', 'field', 'selected', 'picture'],
  faint: ['back', 'panel', 'raised', 'field', 'selected'],
  'chosen-text': ['chosen'],
  'button-text': ['button', 'button-hover'],
  'danger-text': ['danger'],
  good: ['panel'],
  warn: ['panel', 'back'],
  bad: ['panel'],
  'info-text': ['info-back'],
  'good-text': ['good-back'],
  'bad-text': ['bad-back', 'panel', 'raised'],
  'warn-text': ['warn-back', 'panel'],
  'left-out': ['panel'],
  truth: ['panel'],
  ...Object.fromEntries([1, 2, 3, 4, 5, 6].map((n) => [`estimate-${n}`, ['panel', 'raised']])),
  ...Object.fromEntries([1, 2, 3].map((n) => [`neutral-${n}`, ['panel']])),
  ...Object.fromEntries(['x', 'y', 'z'].map((axis) => [`axis-${axis}`, ['panel']])),
};

const kGraphicPairs: Readonly<Record<string, readonly string[]>> = {
  accent: ['panel', 'back', 'raised'],
  cursor: ['panel', 'recorded'],
  idle: ['panel'],
  limit: ['panel'],
  shifted: ['panel'],
  ...Object.fromEntries(
    Object.keys(themes.light ?? {})
      .filter((name) => name.startsWith('fault-'))
      .map((name) => [name, ['back']]),
  ),
};

describe.each(['light', 'dark'] as const)('the %s theme', (theme) => {
  const colours = themes[theme] ?? {};
  const rows = (pairs: Readonly<Record<string, readonly string[]>>) =>
    Object.entries(pairs).flatMap(([front, backs]) => backs.map((back) => [front, back] as const));

  it.each(rows(kTextPairs))('shows text %s on %s', (front, back) => {
    expect(contrast(colours[front] ?? '', colours[back] ?? '')).toBeGreaterThanOrEqual(kText_AA);
  });

  it.each(rows(kGraphicPairs))('shows %s on %s', (front, back) => {
    expect(contrast(colours[front] ?? '', colours[back] ?? '')).toBeGreaterThanOrEqual(
      kGraphics_AA,
    );
  });

  it.each(Object.entries(kSights))('keeps truth and estimates apart with %s', (_name, sight) => {
    const curves = ['truth', ...[1, 2, 3, 4, 5, 6].map((n) => `estimate-${n}`)];
    curves.forEach((a, i) =>
      curves.slice(i + 1).forEach((b) => {
        const apart = seenDistance(colours[a] ?? '', colours[b] ?? '', sight);
        expect(apart, `${a} and ${b}`).toBeGreaterThan(0.06);
      }),
    );
  });
});

describe('the style sheets', () => {
  it('have colours only in themes.css', () => {
    expect(Object.keys(kSheets).length).toBeGreaterThan(5);
    for (const [name, text] of Object.entries(kSheets)) {
      if (name.endsWith('/themes.css')) continue;
      expect(text, name).not.toMatch(/#[0-9a-f]{3,8}\b|rgba?\(|hsla?\(/);
    }
  });

  it('keep truth red and the first estimate blue', () => {
    for (const colours of Object.values(themes)) {
      const [red = 0, green = 0, blue = 0] = channels(colours['truth'] ?? '');
      expect(red).toBeGreaterThan(2 * Math.max(green, blue));
      const [red1 = 0, green1 = 0, blue1 = 0] = channels(colours['estimate-1'] ?? '');
      expect(blue1).toBeGreaterThan(1.5 * Math.max(red1, green1));
    }
  });
});

function channels(hex: string): number[] {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

/** The opaque colours: theme -> name -> #rrggbb. */
function readThemes(): Record<string, Record<string, string>> {
  const text = kSheets['../../src/styles/themes.css'] ?? '';
  const light: Record<string, string> = {};
  const dark: Record<string, string> = {};
  const declared = /--([\w-]+): light-dark\((#[0-9a-f]{6}), (#[0-9a-f]{6})\);/g;
  for (const [, name = '', inLight = '', inDark = ''] of text.matchAll(declared)) {
    light[name] = inLight;
    dark[name] = inDark;
  }
  return { light, dark };
}

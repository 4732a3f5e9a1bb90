// What a viewer copies from a table of errors, against what `overfly evaluate` prints.
import assert from 'node:assert/strict';

const kFigures = [
  'scale',
  'position_rmse_m',
  'horizontal_rmse_m',
  'vertical_rmse_m',
  'percent_of_path',
  'position_rmse_hold_m',
  'rotation_rmse_deg',
  'rotation_euler_norm_rmse_deg',
  'position_auc',
];
const kLengths_m = [100, 200, 400, 800, 1000, 2000, 5000];
const kIntervals_m = [1000, 2000, 5000];

/** Chooses a format in a menu that copies. @return the clipboard's text */
export async function copyFrom(page, menu, format) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.evaluate(() => navigator.clipboard.writeText(''));
  await page.locator(menu).selectOption(format);
  await page.waitForFunction(async () => (await navigator.clipboard.readText()) !== '');
  return page.evaluate(() => navigator.clipboard.readText());
}

/** Lines of a CSV text without quotes, by the names of its columns. */
export function csvRows(text) {
  assert.ok(!text.includes('"'), 'the texts have no commas');
  const [head, ...lines] = text
    .trimEnd()
    .split('\n')
    .map((line) => line.split(','));
  return lines.map((cells) => {
    assert.equal(cells.length, head.length);
    return Object.fromEntries(head.map((name, i) => [name, cells[i]]));
  });
}

/** Every figure of an alignment, by the CSV file's column; undefined where there is none. */
function figuresOf(errors) {
  const figures = new Map(kFigures.map((key) => [key, errors[key] ?? undefined]));
  for (const length_m of kLengths_m) {
    const found = errors.relative.find((one) => one.length_m === length_m);
    figures.set(`translation_percent_${length_m}m`, found?.translation_percent);
    figures.set(`rotation_deg_per_100m_${length_m}m`, found?.rotation_deg_per_100m);
  }
  for (const interval_m of kIntervals_m) {
    const found = errors.fix_drift.find((one) => one.interval_m === interval_m);
    figures.set(`fix_drift_median_${interval_m}m`, found?.median_m);
    figures.set(`fix_drift_worst_${interval_m}m`, found?.worst_m);
  }
  for (const part of ['position', 'rotation', 'pose']) {
    const nees = errors.consistency?.[part] ?? undefined;
    figures.set(`nees_${part}`, nees?.mean);
    figures.set(`nees_${part}_low_95`, nees?.band_95[0]);
    figures.set(`nees_${part}_high_95`, nees?.band_95[1]);
  }
  return figures;
}

/**
 * Compares every number of a CSV row with the printed errors, to 1e-9 of it.
 * @param texts  columns that contain no figure
 * @return how many numbers there were
 */
export function assertFigures(row, errors, texts) {
  const figures = figuresOf(errors);
  const columns = Object.keys(row).filter((name) => !texts.includes(name) && name !== 'honesty');
  assert.deepEqual([...columns].sort(), [...figures.keys()].sort());
  assert.equal(row.honesty, errors.consistency?.honesty ?? '');
  let numbers = 0;
  for (const [name, expected] of figures) {
    if (expected === undefined) {
      assert.equal(row[name], '', name);
      continue;
    }
    const off = Math.abs(Number(row[name]) - expected);
    assert.ok(row[name] !== '' && off <= 1e-9 * Math.abs(expected), `${name}: ${row[name]}`);
    numbers += 1;
  }
  return numbers;
}

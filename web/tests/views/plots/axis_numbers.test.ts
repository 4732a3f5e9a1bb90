import type uPlot from 'uplot';
import { expect, test } from 'vitest';
import { axisNumbers } from '../../../src/views/plots/axis_numbers';

test('numbers of an axis are the same in every language', () => {
  const plot = null as unknown as uPlot;
  expect(axisNumbers(plot, [-1500, 0, 1500], 0, 50, 1500)).toEqual(['−1500', '0', '1500']);
  expect(axisNumbers(plot, [0, 0.5, 1], 0, 50, 0.5)).toEqual(['0.0', '0.5', '1.0']);
});

import type uPlot from 'uplot';
import { expect, test } from 'vitest';
import { axisNumbers, kValueAxis } from '../../../src/views/plots/axis_numbers';

test('numbers of an axis are the same in every language', () => {
  const plot = null as unknown as uPlot;
  expect(axisNumbers(plot, [-1500, 0, 1500], 0, 50, 1500)).toEqual(['−1500', '0', '1500']);
  expect(axisNumbers(plot, [0, 0.5, 1], 0, 50, 0.5)).toEqual(['0.0', '0.5', '1.0']);
});

test('numbers of values follow from the height of the plot', () => {
  const plot = null as unknown as uPlot;
  // 27 px high: a step of 0.5 takes 1.5 px.
  expect(kValueAxis.splits(plot, 1, -4.5, 4.5, 0.5, 1.5)).toEqual([-4, 4]);
  expect(kValueAxis.splits(plot, 1, -4.5, 4.5, 0.1, 1)).toEqual([-4, -2, 0, 2, 4]);
  expect(kValueAxis.values(plot, [-4, 4])).toEqual(['−4', '4']);
  expect(kValueAxis.values(plot, [2.5, 3, 3.5])).toEqual(['2.5', '3.0', '3.5']);
});

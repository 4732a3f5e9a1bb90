import { expect, it } from 'vitest';
import { kPlotGroupNames } from '../../../src/store/plots/plot_group_names';
import { kGroups } from '../../../src/views/plots/plot_groups';

it('every group of plots can be named in a link', () => {
  expect(kGroups.map(({ name }) => name)).toEqual(kPlotGroupNames);
});

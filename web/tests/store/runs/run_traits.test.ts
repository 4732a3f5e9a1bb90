import { describe, expect, it } from 'vitest';
import { runTraits } from '../../../src/store/runs/run_traits';
import { sampleRun } from '../../support/samples';

const flight = (airspeed: number) => `course: ${airspeed} m/s, 45 deg/s, 300 m above the ground`;

describe('runTraits', () => {
  it('sets apart what differs from the other runs of a title', () => {
    const traits = runTraits([
      sampleRun({ id: 'a', flight: flight(15), seed: 1 }),
      sampleRun({ id: 'b', flight: flight(25), seed: 2 }),
      sampleRun({ id: 'c', flight: flight(25), seed: 2, estimators: ['feature', 'process'] }),
      sampleRun({ id: 'd', title: 'Another', seed: 7 }),
    ]);
    const rest = ['45 deg/s', '300 m above the ground'];
    expect(traits.get('a')).toEqual({
      differing: ['course: 15 m/s', 'feature', 'seed 1'],
      common: rest,
    });
    expect(traits.get('c')?.differing).toEqual(['course: 25 m/s', 'feature + process', 'seed 2']);
    expect(traits.get('d')).toEqual({
      differing: [],
      common: ['course: 25 m/s', ...rest, 'seed 7'],
    });
  });

  it('tells repeated flights apart by their seeds', () => {
    const runs = [3, 4].map((seed) => sampleRun({ id: `s${seed}`, seed }));
    expect([...runTraits(runs).values()].map(({ differing }) => differing)).toEqual([
      ['seed 3'],
      ['seed 4'],
    ]);
  });

  it('does not compare flights of different kinds', () => {
    const traits = runTraits([
      sampleRun({ id: 'a', flight: flight(15) }),
      sampleRun({ id: 'b', flight: '', scenario: 'hills' }),
    ]);
    expect(traits.get('b')).toEqual({ differing: [], common: ['hills', 'seed 1'] });
  });
});

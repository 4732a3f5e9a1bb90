// Samples of a run's sensors; docs/PROTOCOL.md is the contract.

/** One value over the time of the run, with its extremes. */
export interface SensorCurve {
  /** With its unit. */
  name: string;
  t_s: number[];
  values: number[];
}

export interface SensorCurves {
  sensor: string;
  /** In the stretch of time asked for. */
  samples: number;
  curves: SensorCurve[];
}

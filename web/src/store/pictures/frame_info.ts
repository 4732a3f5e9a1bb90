// Details of one frame's image: exposure, texture, tiles, faults.
import { formatNumber, formatPercent } from '../format';
import { kTextureLimit } from '../errors/error_table';
import { faultMeaning } from '../fault_spans';
import type { RunData } from '../run_data';
import { lastAtOrBefore } from '../table';

export interface FrameFigure {
  key: string;
  label: string;
  text: string;
  hint: string;
  warn: boolean;
}

export interface FrameInfo {
  figures: FrameFigure[];
  faults: string[];
  /** Shown in large letters over the picture: the estimators received another image, or none. */
  marks: string[];
}

/** @return null if the frame has no row (yet) */
export function frameInfo(data: RunData, frame: number | null): FrameInfo | null {
  if (frame === null) return null;
  const row = lastAtOrBefore(data.truth.column('frame'), frame);
  if (row < 0 || data.truth.at('frame', row) !== frame) return null;
  const faults = [...(data.faults[row] ?? [])];
  return {
    figures: figuresOf(data, row),
    faults,
    marks: faults.flatMap((kind) => faultMeaning(kind).mark ?? []),
  };
}

function figuresOf({ truth }: RunData, row: number): FrameFigure[] {
  const texels = truth.at('texels_per_pixel', row);
  const exposure_ms = truth.at('exposure_ns', row) / 1e6;
  const saturated = truth.at('saturated_fraction', row);
  const late = truth.at('late_tiles', row);
  const offset_ms = truth.at('stamp_offset_ns', row) / 1e6;
  const figures: FrameFigure[] = [
    {
      key: 'exposure',
      label: 'Exposure',
      text: withUnit(formatNumber(exposure_ms, 3), 'ms'),
      hint: 'Exposure time; none = instantaneous',
      warn: false,
    },
    {
      key: 'gain',
      label: 'Gain',
      text: withUnit(formatNumber(truth.at('gain', row), 2), '×'),
      hint: "Of auto-exposure, times the sensor's own",
      warn: false,
    },
    {
      key: 'saturated',
      label: 'Saturated',
      text: Number.isNaN(saturated) ? kNone : formatPercent(saturated, 1),
      hint: 'Pixels at full white',
      warn: saturated > 0.2,
    },
    {
      key: 'texels',
      label: 'Texels/px',
      text: formatNumber(texels, 2),
      hint: `Linear texels of the imagery per pixel, median; below ${kTextureLimit} the imagery limits what the camera can see`,
      warn: texels < kTextureLimit,
    },
    {
      key: 'late',
      label: 'Late tiles',
      text: formatNumber(Number.isNaN(late) ? 0 : late, 0),
      hint: 'Not loaded in time and drawn from a coarser level',
      warn: late > 0,
    },
  ];
  if (!Number.isNaN(offset_ms)) {
    figures.push({
      key: 'stamp',
      label: 'Stamp',
      text: withUnit((offset_ms > 0 ? '+' : '') + formatNumber(offset_ms, 3), 'ms'),
      hint: 'Time stamp given to the estimators minus the true one',
      warn: true,
    });
  }
  return figures;
}

const kNone = '–';

function withUnit(text: string, unit: string): string {
  return text === kNone ? kNone : `${text} ${unit}`;
}

// What else of the screen an address holds, each only where it differs from the default: how the
// tracks, plots and pictures are shown, and how the clock plays.
import type { ClockRange } from '../../protocol/messages';
import type { ClockSettings } from '../playback/clock_settings';
import { kUsualClock } from '../playback/clock_settings';
import { kDefaultAlignment } from '../errors/error_table';
import type { Zoom } from '../pictures/picture_zoom';
import { isZoom, kWholePicture } from '../pictures/picture_zoom';
import { kSpeeds } from '../playback/player';
import type { Span } from '../playback/time_window';
import { kPlotGroupNames } from '../plots/plot_group_names';

export interface LinkChoices {
  alignment: string;
  /** A second alignment; null = none. */
  compared: string | null;
  /** Group of the plots over time; null = the first. */
  plotGroup: string | null;
  /** The part of the clock's time that the plots show; null = all. */
  window_s: Span | null;
  clock: ClockSettings;
  /** The estimator whose debug images are shown; null = the first. */
  debugOf: string | null;
  /** The estimator whose view is compared; null = the camera's image itself. */
  imageErrorOf: string | null;
  /** By group of pictures. */
  zooms: ReadonlyMap<string, Zoom>;
}

const kMostZooms = 40;
const kLongestName = 200;
/** Of the clock: longer than any flight, and exact to the millisecond. */
const kLatest_s = 1e6;
const kShortest_s = 1e-3;

export function usualChoices(): LinkChoices {
  return {
    alignment: kDefaultAlignment,
    compared: null,
    plotGroup: null,
    window_s: null,
    clock: kUsualClock,
    debugOf: null,
    imageErrorOf: null,
    zooms: new Map(),
  };
}

export function writeChoices(choices: LinkChoices, fields: URLSearchParams): void {
  const { alignment, compared, plotGroup, window_s, clock, debugOf, imageErrorOf, zooms } = choices;
  const { range, speed, loop } = clock;
  if (alignment !== kDefaultAlignment) fields.set('align', alignment);
  if (compared !== null) fields.set('compare', compared);
  if (plotGroup !== null) fields.set('plots', plotGroup);
  if (window_s !== null) fields.set('window', window_s.map((t_s) => t_s.toFixed(3)).join(','));
  if (range !== null) {
    fields.set('range', [range.begin_ns, range.end_ns].map(secondsText).join(','));
  }
  if (speed !== 1) fields.set('speed', String(speed));
  if (loop) fields.set('loop', '1');
  if (debugOf !== null) fields.set('debug', debugOf);
  if (imageErrorOf !== null) fields.set('error', imageErrorOf);
  const zoomed = [...zooms].filter(([, { scale }]) => scale !== kWholePicture.scale);
  for (const [group, { scale, x, y }] of zoomed.slice(-kMostZooms)) {
    fields.append('zoom', [...[scale, x, y].map((part) => part.toFixed(4)), group].join(','));
  }
}

/** @param problems  gets the parts that cannot be read, which are left out */
export function readChoices(fields: URLSearchParams, problems: string[]): LinkChoices {
  const usual = usualChoices();
  const read = <T>(name: string, reader: (text: string) => T | null): T | null => {
    const text = fields.get(name);
    return text === null ? null : readPart(name, text, reader, problems);
  };
  const zooms = fields.getAll('zoom');
  if (zooms.length > kMostZooms) problems.push('zoom');
  const range = read('range', secondsPair);
  return {
    alignment: read('align', word) ?? usual.alignment,
    compared: read('compare', word),
    plotGroup: read('plots', plotGroupOf),
    window_s: read('window', secondsPair),
    clock: {
      range: range === null ? null : rangeOf(range),
      speed: read('speed', speedOf) ?? usual.clock.speed,
      loop: read('loop', (text) => (text === '1' ? true : null)) ?? usual.clock.loop,
    },
    debugOf: read('debug', nameOf),
    imageErrorOf: read('error', nameOf),
    zooms: new Map(
      zooms.slice(0, kMostZooms).flatMap((text) => {
        const zoom = readPart('zoom', text, zoomOf, problems);
        return zoom === null ? [] : [zoom];
      }),
    ),
  };
}

/** A part of an address. @return null for what cannot be read, which is noted */
export function readPart<T>(
  name: string,
  text: string,
  reader: (text: string) => T | null,
  problems: string[],
): T | null {
  const value = reader(text);
  if (value === null) problems.push(`${name}=${text.length > 40 ? `${text.slice(0, 40)}…` : text}`);
  return value;
}

/** Exact: at a rounded time the server may show the frame before. */
export function secondsText(t_ns: number): string {
  return (t_ns / 1e9).toFixed(9).replace(/\.?0+$/, '');
}

/** Of an estimator or a camera. */
export function nameOf(text: string): string | null {
  return text !== '' && text.length <= kLongestName ? text : null;
}

function word(text: string): string | null {
  return /^[a-z0-9_]{1,40}$/.test(text) ? text : null;
}

function plotGroupOf(text: string): string | null {
  return kPlotGroupNames.find((name) => name === text) ?? null;
}

function secondsPair(text: string): Span | null {
  const match = /^(-?[0-9.]{1,20}),(-?[0-9.]{1,20})$/.exec(text);
  const [begin, end] = [Number(match?.[1] ?? NaN), Number(match?.[2] ?? NaN)];
  const sane = Math.max(Math.abs(begin), Math.abs(end)) <= kLatest_s;
  return sane && end - begin >= kShortest_s ? [begin, end] : null;
}

function rangeOf([begin_s, end_s]: Span): ClockRange {
  return { begin_ns: Math.round(begin_s * 1e9), end_ns: Math.round(end_s * 1e9) };
}

function speedOf(text: string): number | null {
  const speed = Number(text);
  const magnitude = Math.abs(speed);
  return magnitude >= kSpeeds[0] && magnitude <= (kSpeeds.at(-1) ?? 0) ? speed : null;
}

function zoomOf(text: string): [string, Zoom] | null {
  const [scale, x, y, ...rest] = text.split(',');
  const zoom = { scale: Number(scale), x: Number(x ?? NaN), y: Number(y ?? NaN) };
  const group = nameOf(rest.join(','));
  return group !== null && isZoom(zoom) ? [group, zoom] : null;
}

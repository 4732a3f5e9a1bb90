// Formats numbers for display.

export const kNothing = '–';

/** A number of a document from outside; null if it is missing or no number. */
export function numberOf(value: unknown): number | null {
  return typeof value === 'number' ? value : null;
}

/** From here on with an exponent: errors of an estimator that has diverged may have 300 digits. */
const kLeastWithExponent = 1e10;

/** Fixed digits with a true minus sign; an en dash for a missing value. */
export function formatNumber(value: number | null | undefined, digits: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kNothing;
  const text =
    Math.abs(value) < kLeastWithExponent
      ? value.toFixed(digits)
      : value.toExponential(2).replace('e+', 'e');
  return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
}

export function formatPercent(fraction: number | null | undefined, digits = 1): string {
  if (fraction === null || fraction === undefined) return kNothing;
  return `${formatNumber(fraction * 100, digits)} %`;
}

/** mm:ss.mmm of a time since the run's start, or before it. */
export function formatTime(t_ns: number): string {
  const ms = Math.abs(Math.round(t_ns / 1e6));
  const sign = t_ns < 0 && ms > 0 ? '−' : '';
  const minutes = Math.floor(ms / 60000);
  const seconds = Math.floor(ms / 1000) % 60;
  return `${sign}${pad(minutes, 2)}:${pad(seconds, 2)}.${pad(ms % 1000, 3)}`;
}

/** A duration in its two largest units: "45 s", "3 min 20 s", "2 h 5 min". */
export function formatDuration(duration_s: number): string {
  const seconds = Math.max(0, Math.round(duration_s));
  if (seconds < 60) return `${seconds} s`;
  if (seconds < 3600) return `${Math.floor(seconds / 60)} min ${seconds % 60} s`;
  return `${Math.floor(seconds / 3600)} h ${Math.floor((seconds % 3600) / 60)} min`;
}

/** Local date and time of an ISO 8601 instant, without seconds. */
export function formatDate(utc: string): string {
  const date = new Date(utc);
  if (Number.isNaN(date.getTime())) return utc;
  const day = `${date.getFullYear()}-${pad(date.getMonth() + 1, 2)}-${pad(date.getDate(), 2)}`;
  return `${day} ${pad(date.getHours(), 2)}:${pad(date.getMinutes(), 2)}`;
}

function pad(value: number, digits: number): string {
  return String(value).padStart(digits, '0');
}

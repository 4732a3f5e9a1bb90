// What the REST interface reports when it refuses.
import type { FieldError } from '../protocol/field_errors';
import { readFieldErrors } from '../protocol/field_errors';

/** A response that reports a failure; `status` 0 = the server did not answer. */
export class RestError extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    message: string,
    readonly fieldErrors: FieldError[] = [],
  ) {
    super(message);
  }
}

const kAwayOrBusy: ReadonlySet<number> = new Set([0, 429, 502, 503, 504]);

/** Whether the server was away or busy, so that the same request may succeed later. */
export function isPassing(error: unknown): boolean {
  // What takes too long once takes too long again.
  return error instanceof RestError && kAwayOrBusy.has(error.status) && error.code !== 'timeout';
}

/** Of what was thrown, for people. */
export function errorText(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

/** What to show at the fields of a form; an error of no field has an empty path. */
export function fieldErrorsOf(error: unknown): FieldError[] {
  const message = errorText(error);
  if (!(error instanceof RestError)) return [{ field: '', message }];
  if (error.fieldErrors.length > 0) return error.fieldErrors;
  // "flight.mavlink: must be ..." of a request that is forbidden.
  const [, field, rest] = /^([a-z]\w*(?:\.\w+)+): (.+)$/s.exec(message) ?? [];
  return [field === undefined ? { field: '', message } : { field, message: rest ?? '' }];
}

interface ErrorDocument {
  error: { code: string; message: string; faults?: unknown };
}

/** The error that a response reports. */
export async function errorOf(response: Response): Promise<RestError> {
  try {
    const { error } = (await response.json()) as ErrorDocument;
    const { code, message, faults } = error;
    return new RestError(response.status, code, message, readFieldErrors(faults));
  } catch {
    return new RestError(response.status, 'http', `HTTP ${response.status} ${response.statusText}`);
  }
}

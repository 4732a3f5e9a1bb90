// Errors of a scenario as reported by the server: `error.faults` of a 400.

export interface FieldError {
  /** Dotted path; empty if the error belongs to no field. */
  field: string;
  message: string;
}

/**
 * Reads `error.faults`; removes field and value from the message, since it is shown next to the
 * field.
 */
export function readFieldErrors(entries: unknown): FieldError[] {
  if (!Array.isArray(entries)) return [];
  return entries.filter(isFieldError).map(({ field, message }) => {
    const begin = `${field} = `;
    const colon = message.startsWith(begin) ? message.indexOf(': ', begin.length) : -1;
    return { field, message: colon < 0 ? message : message.slice(colon + 2) };
  });
}

function isFieldError(value: unknown): value is FieldError {
  if (typeof value !== 'object' || value === null) return false;
  const { field, message } = value as Partial<FieldError>;
  return typeof field === 'string' && typeof message === 'string';
}

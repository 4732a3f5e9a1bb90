// Faults of a scenario as the server tells them: `error.faults` of a 400.

export interface Fault {
  /** Dotted path; empty when it is about no field. */
  field: string;
  message: string;
}

/** Reads `error.faults`; what stands beside the field need not name field and value again. */
export function readFaults(faults: unknown): Fault[] {
  if (!Array.isArray(faults)) return [];
  return faults.filter(isFault).map(({ field, message }) => {
    const begin = `${field} = `;
    const colon = message.startsWith(begin) ? message.indexOf(': ', begin.length) : -1;
    return { field, message: colon < 0 ? message : message.slice(colon + 2) };
  });
}

function isFault(value: unknown): value is Fault {
  if (typeof value !== 'object' || value === null) return false;
  const { field, message } = value as Partial<Fault>;
  return typeof field === 'string' && typeof message === 'string';
}

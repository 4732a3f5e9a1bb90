// Faults of a scenario as the server tells them: one a line, "field = value: must be limit".

export interface Fault {
  /** Dotted path; empty when the line names no field. */
  field: string;
  message: string;
}

const kLine = /^([A-Za-z_][\w.[\]-]*)(?: = (.*?))?: (.+)$/;

export function parseFaults(message: string): Fault[] {
  return message
    .split('\n')
    .map((line) => line.trim())
    .filter((line) => line !== '')
    .map((line) => {
      const match = kLine.exec(line);
      if (match === null) return { field: '', message: line };
      const [, field = '', , limit = ''] = match;
      return { field, message: limit };
    });
}

// Tags of runs as text in a form.
import type { Run } from '../../protocol/rest_types';

/** The tags in a text with commas between; each once, without blanks around it. */
export function tagsFrom(text: string): string[] {
  const tags = text.split(',').map((tag) => tag.trim().replace(/\s+/g, ' '));
  return [...new Set(tags.filter((tag) => tag !== ''))];
}

/** All tags of these runs, by name. */
export function knownTags(runs: readonly Run[]): string[] {
  const tags = new Set(runs.flatMap((run) => run.tags));
  return [...tags].sort((a, b) => a.localeCompare(b, undefined, { numeric: true }));
}

// Colours for canvases: those of styles/themes.css as the current theme has them.
import type { Theme } from '../store/themes';

let probe: HTMLElement | null = null;
const known = new Map<string, string>();

/** @param colour  as in a style sheet, for example "var(--truth)" @return the same without variables */
export function paint(colour: string): string {
  const found = known.get(colour);
  if (found !== undefined) return found;
  if (probe === null) {
    probe = document.createElement('span');
    probe.hidden = true;
    document.documentElement.append(probe);
  }
  probe.style.color = '';
  probe.style.color = colour;
  const resolved = getComputedStyle(probe).color;
  known.set(colour, resolved);
  return resolved;
}

/** Shows a theme; canvases must be drawn again after it. */
export function applyTheme(theme: Theme): void {
  if (theme === 'system') delete document.documentElement.dataset['theme'];
  else document.documentElement.dataset['theme'] = theme;
  known.clear();
}

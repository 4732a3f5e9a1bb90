// The header's choice of the theme.
import type { Topic } from '../store/state';
import { kThemes, kThemeTitles } from '../store/themes';
import type { Theme } from '../store/themes';
import { h } from './dom';
import type { Context, View } from './view';

export class ThemeMenu implements View {
  readonly root = h('select', {
    id: 'theme',
    class: 'theme-menu',
    'aria-label': 'Theme',
    title: 'Theme (T)',
  });

  constructor(private readonly context: Context) {
    const names: Record<Theme, string> = { system: 'System', light: 'Light', dark: 'Dark' };
    this.root.append(
      ...kThemes.map((theme) =>
        h('option', { value: theme, title: kThemeTitles[theme] }, names[theme]),
      ),
    );
    this.root.addEventListener('change', () => context.themes.choose(this.root.value as Theme));
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('theme')) this.root.value = this.context.themes.current;
  }
}

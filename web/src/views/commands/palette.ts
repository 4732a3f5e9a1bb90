// The command palette: everything that can be done, found by typing.
import type { Command } from '../../store/palette';
import { matchingCommands, movedChoice } from '../../store/palette';
import type { Topic } from '../../store/state';
import { commandsOf } from './commands';
import { h, setAttribute } from '../dom';
import type { Context, View } from '../view';

export class Palette implements View {
  readonly root: HTMLElement;
  private readonly input = h('input', {
    type: 'text',
    id: 'palette-input',
    placeholder: 'Layout, panel, run, action ...',
    autocomplete: 'off',
    spellcheck: 'false',
    role: 'combobox',
    'aria-label': 'Command',
    'aria-expanded': 'true',
    'aria-controls': 'palette-list',
  });
  private readonly list = h('ul', {
    id: 'palette-list',
    role: 'listbox',
    'aria-label': 'Commands',
  });
  private readonly none = h(
    'div',
    { class: 'palette-none', hidden: true },
    'Nothing is called so.',
  );
  private commands: Command[] = [];
  private found: Command[] = [];
  private choice = 0;
  /** Where the keyboard was before. */
  private before: Element | null = null;

  constructor(private readonly context: Context) {
    const box = h(
      'div',
      { class: 'palette', role: 'dialog', 'aria-modal': 'true', 'aria-label': 'Command palette' },
      this.input,
      this.list,
      this.none,
    );
    this.root = h(
      'div',
      {
        class: 'overlay palette-overlay',
        hidden: true,
        onclick: ({ target }: MouseEvent) => {
          if (target === this.root) this.close();
        },
      },
      box,
    );
    this.input.addEventListener('input', () => {
      this.choice = 0;
      this.draw();
    });
    this.root.addEventListener('keydown', (event) => this.onKey(event));
  }

  update(changed: ReadonlySet<Topic>): void {
    const { paletteOpen } = this.context.store.state;
    if (changed.has('palette') && paletteOpen === this.root.hidden) {
      if (paletteOpen) this.open();
      else this.leave();
    }
  }

  private close(): void {
    this.context.store.setPaletteOpen(false);
  }

  private open(): void {
    this.before = document.activeElement;
    this.commands = commandsOf(this.context);
    this.choice = 0;
    this.input.value = '';
    this.root.hidden = false;
    this.draw();
    this.input.focus();
  }

  private leave(): void {
    this.root.hidden = true;
    this.input.blur(); // the page itself takes no focus
    if (this.before instanceof HTMLElement) this.before.focus();
  }

  private onKey(event: KeyboardEvent): void {
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: 8, PageUp: -8 };
    const step = steps[event.key];
    if (step !== undefined) {
      this.choice = movedChoice(this.choice, step, this.found.length);
      this.mark();
    } else if (event.key === 'Enter') {
      this.run(this.found[this.choice]);
    } else if (event.key === 'Escape') {
      this.close();
    } else if (event.key !== 'Tab') {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private run(command: Command | undefined): void {
    if (command === undefined) return;
    // Before the command: a page that it opens takes the focus.
    this.close();
    command.run();
  }

  private draw(): void {
    this.found = matchingCommands(this.commands, this.input.value);
    this.none.hidden = this.found.length > 0;
    this.list.replaceChildren(
      ...this.found.map((command, i) =>
        h(
          'li',
          {
            role: 'option',
            id: `palette-${i}`,
            'data-command': command.id,
            onclick: () => this.run(command),
          },
          h('span', { class: 'palette-group' }, command.group),
          h('span', { class: 'palette-title' }, command.title),
          command.keys === undefined ? null : h('kbd', {}, command.keys),
        ),
      ),
    );
    this.mark();
  }

  private mark(): void {
    [...this.list.children].forEach((item, i) => {
      setAttribute(item as HTMLElement, 'aria-selected', String(i === this.choice));
    });
    const there = this.found.length > 0;
    setAttribute(this.input, 'aria-activedescendant', there ? `palette-${this.choice}` : null);
    this.list.children[this.choice]?.scrollIntoView({ block: 'nearest' });
  }
}

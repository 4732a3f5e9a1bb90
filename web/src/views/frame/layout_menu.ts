// The header's menu of layouts and panels.
import type { Topic } from '../../store/state';
import { kLongestName } from '../../store/layouts/layouts';
import { kPanelNames, kPanels } from '../../store/layouts/panel_names';
import { kReadyLayouts } from '../../store/layouts/ready_layouts';
import { h, rebuild, setAttribute, setText } from '../dom';
import { icon } from '../icons';
import { Menu } from '../menu';
import type { Context, View } from '../view';
import { exportButton, LayoutFiles } from './layout_files';

export class LayoutMenu implements View {
  readonly root: HTMLElement;
  private readonly label = h('span', { class: 'menu-label' });
  private readonly opener: HTMLElement;
  private readonly menu: Menu;
  private readonly layouts = h('div', { class: 'menu-list', 'data-role': 'layouts' });
  private readonly panels = h('div', { class: 'menu-list', 'data-role': 'panels' });
  private readonly reset: HTMLButtonElement;
  private readonly files: LayoutFiles;
  private readonly name = h('input', {
    type: 'text',
    id: 'layout-name',
    placeholder: 'Name',
    'aria-label': 'Name of the layout to keep',
    maxlength: kLongestName,
    autocomplete: 'off',
  });
  private readonly problem = h('div', { class: 'form-errors', role: 'alert', hidden: true });

  constructor(private readonly context: Context) {
    this.reset = h(
      'button',
      {
        class: 'menu-item',
        type: 'button',
        'data-role': 'reset-layout',
        onclick: () => context.layouts.reset(),
      },
      'Undo my changes of this layout',
    );
    this.files = new LayoutFiles(context);
    const keep = h(
      'form',
      {
        class: 'menu-keep',
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          this.save();
        },
      },
      this.name,
      h('button', { class: 'secondary', type: 'submit' }, 'Keep'),
    );
    const sheet = h(
      'div',
      {
        class: 'menu-sheet',
        id: 'layout-menu',
        role: 'group',
        'aria-label': 'Layout',
      },
      h('h2', {}, 'Layouts'),
      this.layouts,
      this.reset,
      h('h2', {}, 'Keep this arrangement as'),
      keep,
      this.problem,
      this.files.root,
      h('h2', {}, 'Panels'),
      this.panels,
    );
    this.opener = h(
      'button',
      {
        class: 'menu-opener',
        type: 'button',
        title: 'Layouts and panels',
        'data-role': 'layout-menu',
      },
      icon('layout'),
      this.label,
    );
    this.menu = new Menu(this.opener, sheet, () => {
      this.problem.hidden = true;
      this.draw();
    });
    this.root = this.menu.root;
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('layout')) return;
    const { layouts } = this.context;
    setText(this.label, `${layouts.title}${layouts.isChanged ? ' *' : ''}`);
    setAttribute(this.opener, 'aria-label', `Layout: ${this.label.textContent}`);
    setAttribute(this.root, 'data-layout', layouts.current);
    this.reset.disabled = !layouts.isChanged;
    if (this.menu.isOpen) this.draw();
  }

  private draw(): void {
    const { layouts } = this.context;
    const own = layouts.ownNames;
    this.files.update();
    const key = JSON.stringify([own, layouts.current, layouts.isChanged]);
    rebuild(this.layouts, key, () => [
      ...kReadyLayouts.map(({ name, title, hint }) => this.layoutItem(name, title, hint)),
      ...own.map((name) =>
        h(
          'div',
          { class: 'menu-own' },
          this.layoutItem(name, name, 'Your own layout'),
          exportButton(this.context, name),
          h(
            'button',
            {
              class: 'icon-button',
              type: 'button',
              title: `Delete the layout ${name}`,
              'aria-label': `Delete the layout ${name}`,
              onclick: () => layouts.remove(name),
            },
            icon('bin'),
          ),
        ),
      ),
    ]);
    const shown = layouts.panels();
    rebuild(this.panels, shown.join(' '), () =>
      kPanelNames.map((name) => {
        const { title, hint } = kPanels[name];
        const box = h('input', {
          type: 'checkbox',
          checked: shown.includes(name),
          'data-show-panel': name,
          onchange: () => {
            if (shown.includes(name)) layouts.hide(name);
            else layouts.show(name);
          },
        });
        return h('label', { class: 'menu-item', title: hint }, box, title);
      }),
    );
  }

  private layoutItem(name: string, title: string, hint: string): HTMLElement {
    const { layouts } = this.context;
    return h(
      'button',
      {
        class: 'menu-item',
        type: 'button',
        title: hint,
        'data-choose-layout': name,
        'aria-pressed': name === layouts.current ? 'true' : 'false',
        onclick: () => {
          layouts.choose(name);
          this.menu.close();
        },
      },
      title,
    );
  }

  private save(): void {
    const problem = this.context.layouts.saveAs(this.name.value);
    this.problem.hidden = problem === null;
    setText(this.problem, problem ?? '');
    if (problem !== null) return;
    this.name.value = '';
    this.menu.close();
  }
}

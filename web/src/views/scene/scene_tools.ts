// The tools of the 3D view: its modes, following, what it shows, and a picture of it as a file.
import type { SceneMode, ScenePart } from '../../protocol/messages';
import { kSceneModes, kSceneParts } from '../../store/scene/scene_look';
import type { State } from '../../store/state';
import { h, setAttribute } from '../dom';
import { icon } from '../icons';
import type { Context } from '../view';

export class SceneTools {
  /** For the panel's header. */
  readonly buttons: HTMLElement[];
  /** The switches; lies over the view. */
  readonly sheet: HTMLElement;
  private readonly modes = new Map<SceneMode, HTMLElement>();
  private readonly boxes = new Map<ScenePart, HTMLInputElement>();
  private readonly follow: HTMLElement;
  private readonly opener: HTMLElement;

  constructor(context: Context, shoot: () => void) {
    const { scene } = context;
    this.addModes(context);
    this.follow = h(
      'button',
      {
        class: 'tab follow',
        title: 'Keep the aircraft in the middle (F)',
        onclick: () => scene.toggleFollow(),
      },
      'Follow',
    );
    this.opener = h(
      'button',
      {
        class: 'tab',
        'data-role': 'scene-show',
        'aria-expanded': 'false',
        title: 'What the view shows',
        onclick: () => this.open(this.sheet.hidden),
      },
      'Show',
    );
    const shot = h(
      'button',
      {
        class: 'icon-button',
        'data-role': 'scene-shot',
        title: 'Save the view as a picture, with attribution',
        'aria-label': 'Save the view as a picture',
        onclick: shoot,
      },
      icon('photo'),
    );
    this.sheet = h(
      'div',
      { class: 'scene-sheet', hidden: true, role: 'group', 'aria-label': 'What the view shows' },
      ...kSceneParts.map(({ part, label, hint }) => {
        const box = h('input', {
          type: 'checkbox',
          'data-part': part,
          onchange: () => scene.togglePart(part),
        });
        this.boxes.set(part, box);
        return h('label', { title: hint }, box, label);
      }),
    );
    this.buttons = [...this.modes.values(), this.follow, this.opener, shot];
    document.addEventListener('pointerdown', ({ target }) => {
      const inside = (element: HTMLElement) => target instanceof Node && element.contains(target);
      if (!inside(this.sheet) && !inside(this.opener)) this.open(false);
    });
    document.addEventListener('keydown', ({ key }) => {
      if (key === 'Escape') this.open(false);
    });
  }

  draw({ scene }: State): void {
    for (const [mode, button] of this.modes) {
      setAttribute(button, 'aria-pressed', String(mode === scene.mode));
    }
    const canFollow = scene.mode === 'orbit' || scene.mode === 'top';
    setAttribute(this.follow, 'aria-pressed', String(scene.orbits[scene.mode].follow));
    this.follow.hidden = !canFollow;
    for (const [part, box] of this.boxes) box.checked = scene.show.has(part);
  }

  private addModes({ scene }: Context): void {
    for (const { mode, label, hint, key } of kSceneModes) {
      const title = `${hint} (${key})`;
      const choose = () => scene.setMode(mode);
      this.modes.set(
        mode,
        h('button', { class: 'tab', title, 'data-mode': mode, onclick: choose }, label),
      );
    }
  }

  private open(open: boolean): void {
    this.sheet.hidden = !open;
    setAttribute(this.opener, 'aria-expanded', String(open));
  }
}

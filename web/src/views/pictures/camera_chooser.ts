// Chooses one of the main run's cameras.
import type { State } from '../../store/state';
import { h, rebuild } from '../dom';
import type { Context } from '../view';

export class CameraChooser {
  readonly root: HTMLSelectElement;

  constructor(context: Context, id: string) {
    this.root = h('select', { id, 'aria-label': 'Camera', hidden: true });
    this.root.addEventListener('change', () => {
      const first = this.root.selectedIndex === 0;
      context.session.setCamera(first ? null : this.root.value);
    });
  }

  /** Hidden if there is no choice. */
  draw({ cameras, camera }: State): void {
    rebuild(this.root, JSON.stringify(cameras), () =>
      cameras.map(({ name }) => h('option', { value: name }, name)),
    );
    this.root.hidden = cameras.length < 2;
    const shown = cameras.find(({ name }) => name === camera) ?? cameras[0];
    if (shown !== undefined) this.root.value = shown.name;
  }
}

// The tools over the map: what the next click places, undo, what is shown.
import type { MissionDesk } from '../../store/missions/mission_desk';
import { commandTitle, kCommand } from '../../store/missions/mission_item';
import { h } from '../dom';
import type { MissionMap } from './mission_map';

interface Tool {
  command: number | null;
  label: string;
  hint: string;
}

const kTools: readonly Tool[] = [
  { command: null, label: 'Select', hint: 'Select and drag (V)' },
  {
    command: kCommand.takeOff,
    label: 'Take-off',
    hint: 'Place where the climb after the launch leads (T)',
  },
  { command: kCommand.waypoint, label: 'Waypoint', hint: 'Place waypoints (W)' },
  { command: kCommand.circleTurns, label: 'Circle', hint: 'Place circles (C)' },
  { command: kCommand.land, label: 'Landing', hint: 'Place the touchdown (L)' },
];

export class MissionTools {
  readonly root = h('div', {
    class: 'mission-toolbar',
    role: 'toolbar',
    'aria-label': 'Tools of the map',
  });
  /** What a click on the map places; null = it selects. */
  placing: number | null = null;
  private readonly buttons: HTMLButtonElement[];

  constructor(
    private readonly desk: MissionDesk,
    private readonly map: MissionMap,
  ) {
    this.buttons = kTools.map(({ command, label, hint }) =>
      h(
        'button',
        {
          class: 'tab',
          title: hint,
          'data-tool': label.toLowerCase(),
          onclick: () => this.start(command),
        },
        label,
      ),
    );
    const at = (command: number) =>
      h(
        'button',
        {
          class: 'tab',
          title: `Add: ${commandTitle(command).toLowerCase()}, after the selected item`,
          'data-tool': command === kCommand.home ? 'return' : 'speed',
          onclick: () => this.desk.add(command, this.map.middle()),
        },
        command === kCommand.home ? 'Return' : 'Speed',
      );
    const footprints = h('input', {
      type: 'checkbox',
      checked: true,
      'data-role': 'footprints',
      onchange: () => this.map.setFootprints(footprints.checked),
    });
    this.root.append(
      ...this.buttons,
      at(kCommand.home),
      at(kCommand.speed),
      h('span', { class: 'divider' }),
      h(
        'button',
        { class: 'tab', title: 'Show all of it (F)', onclick: () => this.map.fit() },
        'Fit',
      ),
      h('label', { class: 'check', title: 'What the camera sees' }, footprints, 'Footprints'),
    );
    this.show();
  }

  start(command: number | null): void {
    this.placing = command;
    this.map.setPlacing(command !== null);
    this.show();
  }

  stop(): void {
    this.start(null);
  }

  placed(place: [number, number]): void {
    const command = this.placing;
    if (command === null) return;
    this.desk.add(command, place);
    // There is one take-off and one landing.
    if (command === kCommand.takeOff) this.start(kCommand.waypoint);
    if (command === kCommand.land) this.stop();
  }

  private show(): void {
    this.buttons.forEach((button, i) => {
      button.setAttribute('aria-pressed', String(kTools[i]?.command === this.placing));
    });
  }
}

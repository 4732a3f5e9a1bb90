// The fields of the selected item of a mission, or of its home.
import { formatNumber } from '../../store/format';
import type { MissionDesk } from '../../store/missions/mission_desk';
import type { ItemHeights } from '../../store/missions/mission_edit';
import {
  placed,
  reordered,
  withCommand,
  withFrame,
  withHome,
} from '../../store/missions/mission_edit';
import type { MissionItem, SimpleItem } from '../../store/missions/mission_item';
import {
  hasHeight,
  isCircle,
  itemTitle,
  kCommand,
  kFrame,
  kKnownCommands,
  commandTitle,
  numbersOf,
  placeOf,
  radiusIndex,
  withParam,
} from '../../store/missions/mission_item';
import type { MissionPage } from '../../store/missions/mission_page';
import { h, setText } from '../dom';
import { icon } from '../icons';
import type { Field } from './fields';
import { choiceField, numberField } from './fields';
import { placesByItem } from './item_list';

const kFrames = [
  { value: String(kFrame.aboveGround), label: 'above the ground' },
  { value: String(kFrame.aboveHome), label: 'above home' },
  { value: String(kFrame.seaLevel), label: 'above sea level' },
];

export class ItemForm {
  readonly root = h('section', { class: 'mission-form', 'data-role': 'mission-form' });
  private readonly title = h('h3', {});
  private readonly info = h('p', { class: 'mission-info', 'data-role': 'item-info' });
  private readonly tools: HTMLElement;
  private readonly body = h('div', { class: 'mission-fields' });
  private fields: Field[] = [];
  private key = '';
  private page: MissionPage | null = null;

  constructor(private readonly desk: MissionDesk) {
    this.tools = h(
      'span',
      { class: 'mission-tools' },
      this.tool('Earlier', 'stepBack', -1),
      this.tool('Later', 'stepForward', 1),
    );
    this.root.append(h('header', {}, this.title, this.tools), this.body, this.info);
  }

  show(page: MissionPage): void {
    this.page = page;
    const { draft } = page;
    this.root.hidden = draft === null;
    if (draft === null) return;
    const item = this.item();
    const key =
      item === null ? 'home' : `${item.id} ${item.kind === 'simple' ? item.command : 'complex'}`;
    if (key !== this.key) {
      this.key = key;
      this.fields = item === null ? this.homeFields() : this.itemFields(item);
      this.body.replaceChildren(...this.fields.map(({ root }) => root));
    }
    this.tools.hidden = item === null;
    const number = item === null ? 0 : this.numberOf(item);
    setText(this.title, item === null ? 'Home' : `${number} · ${itemTitle(item)}`);
    setText(this.info, this.infoText(item));
    for (const field of this.fields) field.show();
  }

  private tool(label: string, name: 'stepBack' | 'stepForward', step: number): HTMLElement {
    return h(
      'button',
      {
        class: 'icon-button',
        title: `${label} in the mission`,
        'aria-label': `${label} in the mission`,
        onclick: () => {
          const item = this.item();
          if (item !== null) this.desk.edit((mission) => reordered(mission, item.id, step));
        },
      },
      icon(name),
    );
  }

  private item(): MissionItem | null {
    const { draft, selected } = this.page ?? {};
    return draft?.mission.items.find(({ id }) => id === selected) ?? null;
  }

  private simple(): SimpleItem | null {
    const item = this.item();
    return item?.kind === 'simple' ? item : null;
  }

  private numberOf(item: MissionItem): number {
    const mission = this.page?.draft?.mission;
    if (mission === undefined) return 0;
    return numbersOf(mission)[mission.items.indexOf(item)] ?? 0;
  }

  private infoText(item: MissionItem | null): string {
    const { report, world, draft } = this.page ?? {};
    if (item === null) {
      if (world === null || draft === null) return '';
      return 'Heights above home count from the ground here. The flight begins here.';
    }
    if (item.kind === 'complex') {
      return item.count === 0
        ? 'The plan contains no items for it: it cannot be flown.'
        : `Flown as ${item.count} items, and kept as it is.`;
    }
    const place = placesByItem(report ?? null).get(this.numberOf(item));
    if (place === undefined) return '';
    const parts = [`${formatNumber(place.height_agl_m, 0)} m above the ground`];
    if (place.turn_bank_deg !== null) {
      parts.push(
        `turn with ${formatNumber(place.turn_bank_deg, 0)}° of bank, radius ${formatNumber(place.turn_radius_m ?? 0, 0)} m`,
      );
    }
    if (place.reached_s !== null) parts.push(`done at ${formatNumber(place.reached_s, 0)} s`);
    return parts.join(' · ');
  }

  private homeFields(): Field[] {
    const home = () => this.page?.draft?.mission.home;
    const set = (change: Partial<{ lat_deg: number; lon_deg: number; alt_msl_m: number }>) => {
      this.desk.edit(
        (mission) => withHome(mission, { ...mission.home, ...change }),
        `home ${Object.keys(change).join()}`,
      );
    };
    return [
      this.degrees(
        'home-lat',
        'Latitude',
        90,
        () => home()?.lat_deg ?? null,
        (lat_deg) => set({ lat_deg }),
      ),
      this.degrees(
        'home-lon',
        'Longitude',
        180,
        () => home()?.lon_deg ?? null,
        (lon_deg) => set({ lon_deg }),
      ),
      numberField({
        id: 'home-alt',
        label: 'Height',
        unit: 'm AMSL',
        hint: 'Above sea level, for ground stations. Overfly takes the ground of its world.',
        digits: 1,
        get: () => home()?.alt_msl_m ?? null,
        set: (alt_msl_m) => set({ alt_msl_m }),
      }),
    ];
  }

  private degrees(
    id: string,
    label: string,
    limit: number,
    get: () => number | null,
    set: (value: number) => void,
  ): Field {
    return numberField({
      id,
      label,
      unit: 'deg',
      step: 1e-5,
      min: -limit,
      max: limit,
      digits: 7,
      get,
      set,
    });
  }

  private itemFields(item: MissionItem): Field[] {
    if (item.kind === 'complex') return [];
    const { id, command } = item;
    const fields: Field[] = [this.commandField(id)];
    if (hasHeight(item)) fields.push(...this.heightFields(id, command));
    if (isCircle(command)) fields.push(...this.circleFields(id, command));
    if (command === kCommand.waypoint) {
      fields.push(
        this.param(id, 1, {
          label: 'Turn begins',
          unit: 'm before',
          hint: 'Distance to the waypoint at which the turn to the next line begins; 0 = by the autopilot',
          step: 5,
          min: 0,
          max: 10000,
        }),
      );
    }
    if (command === kCommand.speed) {
      fields.push(this.param(id, 1, { label: 'Airspeed', unit: 'm/s', step: 1, min: 5, max: 80 }));
    }
    if (placeOf(item) !== null) fields.push(...this.placeFields(id));
    return fields;
  }

  private commandField(id: number): Field {
    return choiceField({
      id: 'item-command',
      label: 'Type',
      choices: () =>
        kKnownCommands.map((command) => ({ value: String(command), label: commandTitle(command) })),
      get: () => String(this.simple()?.command ?? ''),
      set: (value) => this.desk.edit((mission) => withCommand(mission, id, Number(value))),
    });
  }

  private heightFields(id: number, command: number): Field[] {
    const height = this.param(id, 6, {
      label: 'Height',
      unit: 'm',
      step: 10,
      min: -1000,
      max: 20000,
      digits: 1,
    });
    if (command === kCommand.takeOff || command === kCommand.land) return [height];
    const frame = choiceField({
      id: 'item-frame',
      label: 'counts',
      choices: () => kFrames,
      get: () => String(plainFrame(this.simple()?.frame ?? 0)),
      set: (value) =>
        this.desk.edit((mission) => withFrame(mission, id, Number(value), this.heights())),
    });
    return [height, frame];
  }

  /** Of the selected item, by the last report; null if that is not of this mission. */
  private heights(): ItemHeights | null {
    const { report, outdated } = this.page ?? {};
    const item = this.item();
    if (report === null || report === undefined || outdated === true || item === null) return null;
    const place = placesByItem(report).get(this.numberOf(item));
    if (place === undefined || this.simple() === null) return null;
    return { above_ground_m: place.height_agl_m, above_home_m: place.height_above_home_m };
  }

  private circleFields(id: number, command: number): Field[] {
    const at = radiusIndex(command);
    const side = (item: SimpleItem) => ((item.params[at] ?? 0) < 0 ? -1 : 1);
    const fields: Field[] = [
      numberField({
        id: 'item-radius',
        label: 'Radius',
        unit: 'm',
        step: 10,
        min: 1,
        max: 10000,
        get: () => Math.abs(this.simple()?.params[at] ?? 0),
        set: (value) =>
          this.desk.editItem(id, (item) => withParam(item, at, side(item) * value), `${id} radius`),
      }),
      choiceField({
        id: 'item-side',
        label: 'Direction',
        choices: () => [
          { value: '1', label: 'clockwise' },
          { value: '-1', label: 'counterclockwise' },
        ],
        get: () => String(side(this.simple() ?? { ...kNoItem })),
        set: (value) =>
          this.desk.editItem(id, (item) =>
            withParam(item, at, Number(value) * Math.abs(item.params[at] ?? 0)),
          ),
      }),
    ];
    if (command === kCommand.circleTurns) {
      fields.push(this.param(id, 0, { label: 'Turns', unit: '', step: 1, min: 0, max: 10000 }));
    }
    if (command === kCommand.circleTime) {
      fields.push(this.param(id, 0, { label: 'Time', unit: 's', step: 10, min: 0, max: 86400 }));
    }
    return fields;
  }

  private placeFields(id: number): Field[] {
    const place = () => {
      const item = this.item();
      return item === null ? null : placeOf(item);
    };
    const set = (lat: number | null, lon: number | null) => {
      const now = place();
      if (now === null) return;
      this.desk.edit(
        (mission) => placed(mission, id, [lat ?? now[0], lon ?? now[1]]),
        `${id} ${lat === null ? 'lon' : 'lat'}`,
      );
    };
    return [
      this.degrees(
        'item-lat',
        'Latitude',
        90,
        () => place()?.[0] ?? null,
        (lat) => set(lat, null),
      ),
      this.degrees(
        'item-lon',
        'Longitude',
        180,
        () => place()?.[1] ?? null,
        (lon) => set(null, lon),
      ),
    ];
  }

  private param(
    id: number,
    index: number,
    options: {
      label: string;
      unit: string;
      hint?: string;
      step: number;
      min: number;
      max: number;
      digits?: number;
    },
  ): Field {
    return numberField({
      ...options,
      id: `item-param-${index}`,
      get: () => this.simple()?.params[index] ?? 0,
      set: (value) =>
        this.desk.editItem(id, (item) => withParam(item, index, value), `${id} ${index}`),
    });
  }
}

const kNoItem: SimpleItem = {
  kind: 'simple',
  command: 0,
  frame: 0,
  params: [],
  autoContinue: true,
  extra: {},
};

/** Without the twins that only say that positions are integers. */
function plainFrame(frame: number): number {
  if (frame === 5) return kFrame.seaLevel;
  if (frame === 6) return kFrame.aboveHome;
  return frame === 11 ? kFrame.aboveGround : frame;
}

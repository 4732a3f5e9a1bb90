// The page of missions: a map, the items, what the mission will be like, and its files.
import { metresPerDegree } from '../../store/metres_per_degree';
import { formatNumber } from '../../store/format';
import { neighbour, nudged, placed, withHome } from '../../store/missions/mission_edit';
import { itemOfNumber, kCommand } from '../../store/missions/mission_item';
import type { MissionPage } from '../../store/missions/mission_page';
import type { Topic } from '../../store/state';
import { viewerNote } from '../access';
import { h, rebuild } from '../dom';
import type { Context, View } from '../view';
import type { CheckGroup } from './checks';
import { checkGroups } from './checks';
import { GroundReadout } from './ground_readout';
import { ItemList } from './item_list';
import { sampleAt } from './map_paths';
import { MissionBar } from './mission_bar';
import { MissionMap } from './mission_map';
import { MissionProfile } from './mission_profile';
import { MissionSettings } from './mission_settings';
import { MissionTools } from './mission_tools';

const kNudge_m = 10;

export class MissionPageView implements View {
  readonly root: HTMLElement;
  private readonly bar: MissionBar;
  private readonly tools: MissionTools;
  private readonly map: MissionMap;
  private readonly items: ItemList;
  private readonly settings: MissionSettings;
  private readonly profile: MissionProfile;
  private readonly readout: GroundReadout;
  private readonly checks = h('ul', { class: 'mission-checks', 'data-role': 'mission-checks' });
  private readonly message = h('div', { class: 'mission-message', role: 'status', hidden: true });
  /** The mission and the world that were shown as a whole. */
  private fitted: string | null = null;

  constructor(private readonly context: Context) {
    const { missions, rest, store } = context;
    this.map = new MissionMap(this.mapActions(), (world) => rest.tileAddress(world));
    this.tools = new MissionTools(missions, this.map);
    this.bar = new MissionBar(context);
    this.items = new ItemList(missions);
    this.settings = new MissionSettings(missions, store.state);
    this.profile = new MissionProfile((distance_m) => missions.moveCursor(distance_m));
    this.readout = new GroundReadout(rest);
    this.root = h(
      'div',
      {
        class: 'mission-page',
        role: 'dialog',
        'aria-label': 'Missions',
        onkeydown: (event: KeyboardEvent) => this.onKey(event),
      },
      this.bar.root,
      this.items.root,
      h(
        'div',
        { class: 'mission-centre' },
        h(
          'div',
          { class: 'mission-stage' },
          this.map.root,
          this.tools.root,
          this.readout.root,
          this.message,
        ),
        this.profile.root,
      ),
      h(
        'aside',
        { class: 'mission-right' },
        this.settings.root,
        h('section', { class: 'mission-verdict' }, h('h3', {}, 'Checks'), this.checks),
      ),
    );
    this.listenToKeys();
  }

  update(changed: ReadonlySet<Topic>): void {
    const { missionPage } = this.context.store.state;
    if (!missionPage.open) return;
    if (changed.has('theme')) {
      this.map.repaint();
      this.profile.repaint();
    }
    if (changed.has('missionCursor')) {
      this.map.showCursor(missionPage);
      this.profile.show(missionPage);
    }
    if (!changed.has('missions') && !changed.has('lists')) return;
    this.bar.show(missionPage);
    this.items.show(missionPage);
    this.settings.show();
    this.map.show(missionPage);
    this.profile.show(missionPage);
    this.showChecks(missionPage);
    this.showMessage(missionPage);
    this.readout.setWorld(missionPage.world?.name ?? null);
    this.fitOnce(missionPage);
  }

  /** Shows a mission that was just opened as a whole. */
  private fitOnce({ draft, opened, world }: MissionPage): void {
    if (draft === null || world === null) return;
    const key = `${opened} ${draft.world}`;
    if (this.fitted === key) return;
    this.fitted = key;
    this.map.fit();
  }

  private mapActions() {
    const { missions } = this.context;
    return {
      onGround: (place: [number, number]) => {
        const command = this.tools.placing;
        if (command === null) missions.select(null);
        else this.tools.placed(place);
      },
      onSelect: (id: number | null) => missions.select(id),
      onMove: (id: number | null, place: [number, number]) =>
        missions.edit((mission) =>
          id === null
            ? withHome(mission, { ...mission.home, lat_deg: place[0], lon_deg: place[1] })
            : placed(mission, id, place),
        ),
      onInsert: (index: number, place: [number, number]) =>
        missions.add(kCommand.waypoint, place, index),
      onHover: (place: [number, number] | null) => this.readout.hover(place),
      onCursor: (distance_m: number | null) => missions.moveCursor(distance_m),
    };
  }

  private showChecks({ draft, report, errors, outdated }: MissionPage): void {
    this.checks.classList.toggle('outdated', outdated);
    const isEmpty = draft === null || draft.mission.items.length === 0;
    rebuild(this.checks, JSON.stringify([isEmpty, errors, report?.warnings ?? null]), () => {
      if (errors.length > 0) {
        return errors.map(({ field, message }) =>
          h('li', { 'data-kind': 'error' }, field === '' ? message : `${field}: ${message}`),
        );
      }
      if (report === null) {
        const text = isEmpty
          ? 'Place items on the map: they are checked as you draw.'
          : 'The mission is being checked.';
        return [h('li', { class: 'muted' }, text)];
      }
      const groups = checkGroups(report.warnings);
      if (groups.length === 0) return [h('li', { class: 'fine' }, 'All limits are kept.')];
      return groups.map((group) => this.checkGroup(group));
    });
  }

  private checkGroup({ kind, title, places }: CheckGroup): HTMLElement {
    return h(
      'li',
      { 'data-kind': kind },
      h('b', {}, title),
      ...places.map(({ text, hint, warning }) =>
        h(
          'button',
          {
            'data-of': `${kind} ${text}`,
            title: hint,
            onclick: () => this.goTo(warning.item, warning.from_s),
          },
          text,
        ),
      ),
    );
  }

  /** Shows where a warning belongs. */
  private goTo(number: number | null, from_s: number | null): void {
    const { draft, report } = this.context.store.state.missionPage;
    const { missions } = this.context;
    if (number !== null && draft !== null) {
      missions.select(itemOfNumber(draft.mission, number)?.id ?? null);
    }
    if (from_s === null || report === null) return;
    const at = sampleAt(report.samples, from_s);
    missions.moveCursor(report.samples.distance_m[at] ?? null);
    this.map.goTo([report.samples.lat_deg[at] ?? 0, report.samples.lon_deg[at] ?? 0]);
  }

  private showMessage({
    worldMissing,
    worldError,
    listError,
    making,
    world,
    draft,
    worlds,
  }: MissionPage): void {
    const { missions } = this.context;
    // Without the list of worlds there is no scenario to be checked or flown.
    const problem = worldError ?? (worlds === null ? listError : null);
    const state = JSON.stringify([
      worldMissing,
      problem,
      making === null ? null : Math.round(making * 100),
      world === null,
      missions.isElsewhere,
      draft === null,
      worlds === null,
    ]);
    rebuild(this.message, state, () => {
      if (problem !== null) return [h('p', {}, problem)];
      if (making !== null)
        return [h('p', {}, `Making the built-in world: ${formatNumber(making * 100, 0)} %`)];
      if (worldMissing) {
        const make = () => void missions.makeWorld();
        return [
          h('p', {}, 'The built-in world was not made yet.'),
          h('button', { class: 'primary', 'data-changes': true, onclick: make }, 'Make it now'),
          viewerNote("Making it needs the operator's address."),
        ];
      }
      if (world === null) return draft === null ? [] : [h('p', {}, 'Opening the world')];
      if (!missions.isElsewhere) return [];
      const move = () => {
        missions.moveToWorld();
        this.map.fit();
      };
      return [
        h('p', {}, 'The mission lies outside of this world.'),
        h('button', { class: 'primary', onclick: move }, 'Move it here'),
      ];
    });
    this.message.hidden = this.message.childElementCount === 0;
  }

  /** After a click on a button or on the map nothing has the focus, but keys are for this page. */
  private listenToKeys(): void {
    const listen = (event: KeyboardEvent) => {
      const { missionPage, topPage, connect, paletteOpen, helpOpen } = this.context.store.state;
      const isFree = topPage === missionPage && !connect.open && !paletteOpen && !helpOpen;
      if (isFree && event.target === document.body) this.onKey(event);
    };
    document.addEventListener('keydown', listen, true);
  }

  private onKey(event: KeyboardEvent): void {
    const command = event.ctrlKey || event.metaKey;
    const { target } = event;
    const typing =
      target instanceof HTMLSelectElement ||
      (target instanceof HTMLInputElement && target.type !== 'checkbox');
    if (event.key === 'Escape' && this.tools.placing !== null) this.tools.stop();
    else if (event.key === 'Escape' || (command && event.key === 'k') || event.key === '?') return;
    else if (command && this.onCommand(event)) event.preventDefault();
    else if (!typing && !command && this.onPlainKey(event)) event.preventDefault();
    // The keys of the flights behind this page rest.
    event.stopPropagation();
  }

  private onCommand({ key, shiftKey }: KeyboardEvent): boolean {
    const { missions, store } = this.context;
    switch (key.toLowerCase()) {
      case 'z':
        if (shiftKey) missions.redo();
        else missions.undo();
        return true;
      case 'y':
        missions.redo();
        return true;
      case 's':
        if (store.state.mayChange) void missions.save();
        return true;
    }
    return false;
  }

  private onPlainKey({ key, shiftKey }: KeyboardEvent): boolean {
    const { missions, store } = this.context;
    const { draft, selected } = store.state.missionPage;
    if (draft === null) return false;
    // It presses the button that has the focus, unless something is being placed.
    if (key === 'Enter' && this.tools.placing === null) return false;
    const step = shiftKey ? 10 * kNudge_m : kNudge_m;
    const nudge = (east: number, north: number) => {
      if (selected === null) this.map.goTo(this.shifted(east * step * 10, north * step * 10));
      else
        missions.edit(
          (mission) => nudged(mission, selected, east * step, north * step),
          `nudge ${selected}`,
        );
    };
    const actions: Record<string, () => void> = {
      Delete: () => selected !== null && missions.remove(selected),
      Backspace: () => selected !== null && missions.remove(selected),
      ArrowUp: () => nudge(0, 1),
      ArrowDown: () => nudge(0, -1),
      ArrowLeft: () => nudge(-1, 0),
      ArrowRight: () => nudge(1, 0),
      '[': () => missions.select(neighbour(draft.mission, selected, -1)),
      ']': () => missions.select(neighbour(draft.mission, selected, 1)),
      v: () => this.tools.stop(),
      w: () => this.tools.start(kCommand.waypoint),
      c: () => this.tools.start(kCommand.circleTurns),
      t: () => this.tools.start(kCommand.takeOff),
      l: () => this.tools.start(kCommand.land),
      Enter: () => this.tools.placed(this.map.middle()),
      f: () => this.map.fit(),
    };
    const action = actions[key];
    action?.();
    return action !== undefined;
  }

  private shifted(east_m: number, north_m: number): [number, number] {
    const [lat, lon] = this.map.middle();
    const scale = metresPerDegree(lat);
    return [lat + north_m / scale.north, lon + east_m / scale.east];
  }
}

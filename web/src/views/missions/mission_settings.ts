// What a mission is flown with: world, aircraft, air, camera; and the limits that are checked.
import type { MissionDesk } from '../../store/missions/mission_desk';
import type { FlightSettings } from '../../store/missions/mission_document';
import { camerasOf, kUsualFlight } from '../../store/missions/mission_document';
import type { MissionPage } from '../../store/missions/mission_page';
import type { State } from '../../store/state';
import { h } from '../dom';
import type { Field } from './fields';
import { choiceField, numberField } from './fields';

const kAirframes = [
  { value: 'foam_trainer', label: 'Foam trainer, 8–19 m/s' },
  { value: 'piper_cub_third', label: 'Piper Cub 1/3, 10–37 m/s' },
  { value: 'aerosonde', label: 'Aerosonde, 16–32 m/s' },
];
const kTurbulence = ['none', 'light', 'moderate', 'severe'].map((value) => ({
  value,
  label: value,
}));

interface LimitInfo {
  name: keyof MissionPage['limits'];
  label: string;
  unit: string;
  step: number;
  min: number;
  max: number;
  hint: string;
}

const kLimits: readonly LimitInfo[] = [
  {
    name: 'min_clearance_m',
    label: 'Least height',
    unit: 'm',
    step: 10,
    min: 0,
    max: 10000,
    hint: 'Above the ground, except in take-off and landing',
  },
  {
    name: 'max_bank_deg',
    label: 'Most bank',
    unit: 'deg',
    step: 5,
    min: 1,
    max: 90,
    hint: 'The autopilot has its own limit, ROLL_LIMIT_DEG',
  },
  {
    name: 'min_overlap',
    label: 'Least overlap',
    unit: '',
    step: 0.05,
    min: 0,
    max: 1,
    hint: 'Share of the ground in an image that a later image shows again',
  },
  {
    name: 'min_texels_px',
    label: 'Least texels',
    unit: 'per px',
    step: 0.1,
    min: 0,
    max: 1000,
    hint: 'Below 0.5 the imagery limits the result, not the camera',
  },
  {
    name: 'max_motion_px',
    label: 'Most motion',
    unit: 'px/frame',
    step: 5,
    min: 0,
    max: 1e6,
    hint: 'Of the image, by translation and rotation',
  },
  {
    name: 'min_imagery',
    label: 'Least imagery',
    unit: '',
    step: 0.05,
    min: 0,
    max: 1,
    hint: 'Share of the image over imagery',
  },
  {
    name: 'min_start_s',
    label: 'Start lasts',
    unit: 's',
    step: 1,
    min: 0,
    max: 3600,
    hint: 'Straight and level flight in which estimators initialise',
  },
  {
    name: 'min_start_baseline',
    label: 'Start length',
    unit: '/ height',
    step: 0.1,
    min: 0,
    max: 1000,
    hint: 'Length of the straight and level start over the height above the ground',
  },
];

export class MissionSettings {
  readonly root = h('section', { class: 'mission-settings', 'data-role': 'mission-settings' });
  private readonly fields: Field[];

  constructor(
    private readonly desk: MissionDesk,
    private readonly state: State,
  ) {
    const flown = [this.world(), this.base(), this.camera(), ...this.flight()];
    const limits = this.limits();
    this.fields = [...flown, ...limits];
    const checks = h('details', {}, h('summary', {}, 'Limits that are checked'));
    checks.append(...limits.map(({ root }) => root));
    this.root.append(h('h3', {}, 'Flown with'), ...flown.map(({ root }) => root), checks);
  }

  show(): void {
    for (const field of this.fields) field.show();
  }

  private get page(): MissionPage {
    return this.state.missionPage;
  }

  private world(): Field {
    return choiceField({
      id: 'mission-world',
      label: 'World',
      choices: () =>
        (this.page.worlds ?? []).map(({ name, title, made }) => ({
          value: name,
          label: made ? title : `${title} (not made yet)`,
        })),
      get: () => this.page.draft?.world ?? '',
      set: (value) => void this.desk.chooseWorld(value),
    });
  }

  private base(): Field {
    return choiceField({
      id: 'mission-base',
      label: 'Settings of',
      hint: 'The scenario whose cameras, estimators, sensors, light and pacing are used',
      choices: () =>
        (this.state.scenarios ?? [])
          .filter(({ error }) => error === null)
          .map(({ name, title }) => ({ value: name, label: title })),
      get: () => this.page.draft?.base ?? '',
      set: (value) => void this.desk.chooseBase(value),
    });
  }

  private camera(): Field {
    return choiceField({
      id: 'mission-camera',
      label: 'Camera',
      hint: 'The camera of the footprints and figures',
      choices: () => {
        const { draft } = this.page;
        return draft === null
          ? []
          : camerasOf(draft.baseDocument).map((name) => ({ value: name, label: name }));
      },
      get: () => {
        const { camera, draft } = this.page;
        return camera !== '' || draft === null ? camera : (camerasOf(draft.baseDocument)[0] ?? '');
      },
      set: (camera) => this.desk.setReport({ camera }),
    });
  }

  private flight(): Field[] {
    const get = () => this.page.draft?.flight ?? kUsualFlight;
    const set = (change: Partial<FlightSettings>, kind: string | null = null) =>
      this.desk.set({ flight: { ...get(), ...change } }, kind);
    return [
      choiceField({
        id: 'mission-airframe',
        label: 'Aircraft',
        choices: () => kAirframes,
        get: () => get().airframe,
        set: (airframe) => set({ airframe }),
      }),
      numberField({
        id: 'mission-airspeed',
        label: 'Airspeed',
        unit: 'm/s',
        min: 5,
        max: 80,
        get: () => get().airspeed_m_s,
        set: (airspeed_m_s) => set({ airspeed_m_s }, 'airspeed'),
      }),
      numberField({
        id: 'mission-wind',
        label: 'Wind',
        unit: 'm/s',
        min: 0,
        max: 40,
        get: () => get().wind_m_s,
        set: (wind_m_s) => set({ wind_m_s }, 'wind'),
      }),
      numberField({
        id: 'mission-wind-from',
        label: 'Wind from',
        unit: 'deg',
        hint: 'Clockwise from north: 270 is wind from the west',
        step: 10,
        min: -360,
        max: 360,
        get: () => get().wind_from_deg,
        set: (wind_from_deg) => set({ wind_from_deg }, 'wind from'),
      }),
      choiceField({
        id: 'mission-turbulence',
        label: 'Turbulence',
        choices: () => kTurbulence,
        get: () => get().turbulence,
        set: (turbulence) => set({ turbulence }),
      }),
    ];
  }

  private limits(): Field[] {
    return [...kLimits.map((limit) => this.limit(limit)), this.interval()];
  }

  private interval(): Field {
    return numberField({
      id: 'limit-interval',
      label: 'Overlap after',
      unit: 's',
      hint: 'Time between the images whose overlap is shown',
      step: 0.1,
      min: 0.001,
      max: 600,
      get: () => this.page.overlapInterval_s,
      set: (overlapInterval_s) => this.desk.setReport({ overlapInterval_s }),
    });
  }

  private limit({ name, ...options }: LimitInfo): Field {
    return numberField({
      ...options,
      id: `limit-${name}`,
      get: () => this.page.limits[name],
      set: (value) => this.desk.setReport({ limits: { ...this.page.limits, [name]: value } }),
    });
  }
}

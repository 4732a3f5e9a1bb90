// Keeps the mission that is being drawn in the browser, so that a closed page loses nothing.
import type { JsonObject } from '../../protocol/rest_types';
import type { Storage } from '../layouts/layouts';
import type { MissionDraft } from './mission_page';
import { flightOf } from './mission_document';
import type { NewId } from './plan_file';
import { isObject, missionFromPlan, planFromMission } from './plan_file';

const kKey = 'overfly.mission';

export function writeDraft(storage: Storage, draft: MissionDraft | null): void {
  if (draft === null) return;
  const { mission, ...rest } = draft;
  try {
    storage.setItem(kKey, JSON.stringify({ ...rest, plan: planFromMission(mission) }));
  } catch {
    // The browser keeps nothing, or too much is kept already: the page works without it.
  }
}

/** What has been drawn, to be compared: not where it is saved. */
export function drawnText({ title, base, world, flight, mission }: MissionDraft): string {
  return JSON.stringify([title, base, world, flight, mission]);
}

/** null without a draft, or with one that cannot be read. */
export function readDraft(storage: Storage, newId: NewId): MissionDraft | null {
  try {
    const kept = JSON.parse(storage.getItem(kKey) ?? 'null') as JsonObject | null;
    if (kept === null) return null;
    const { title, name, base, baseDocument, world, flight, plan } = kept;
    if (
      typeof title !== 'string' ||
      typeof base !== 'string' ||
      typeof world !== 'string' ||
      !isObject(baseDocument) ||
      !isObject(flight) ||
      plan === undefined
    ) {
      return null;
    }
    const { wind_from_deg, wind_m_s, rest, ...settings } = flight;
    const wind = { from_deg: wind_from_deg ?? 270, speed_m_s: wind_m_s ?? 0 };
    const more = isObject(rest) ? rest : {};
    return {
      title,
      name: typeof name === 'string' ? name : null,
      base,
      baseDocument,
      world,
      // As of a scenario, so that every field is checked.
      flight: flightOf({ flight: { mission: { ...more, ...settings, wind } } }),
      mission: missionFromPlan(plan, newId),
    };
  } catch {
    return null;
  }
}

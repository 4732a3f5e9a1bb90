// Missions as files of ground stations.
import type { Mission } from './mission_item';
import type { NewId } from './plan_file';
import { MissionFileError, planText, readPlanText } from './plan_file';
import { readWaypoints, writeWaypoints } from './waypoints_file';

const kMost_bytes = 8 << 20;

export type MissionFormat = 'plan' | 'waypoints';

/** A file to be saved by the browser. */
export interface MissionFile {
  name: string;
  text: string;
}

export type ReadableFile = Pick<File, 'name' | 'size' | 'text'>;

/** Reads either format, by the content. Errors: MissionFileError. */
export async function readMissionFile(file: ReadableFile, newId: NewId): Promise<Mission> {
  if (file.size > kMost_bytes) {
    throw new MissionFileError(`${file.size} bytes: must be at most ${kMost_bytes}`);
  }
  const text = await file.text();
  return text.trimStart().startsWith('{') ? readPlanText(text, newId) : readWaypoints(text, newId);
}

/** @return with what the format cannot hold, for people */
export function writeMissionFile(
  mission: Mission,
  name: string,
  format: MissionFormat,
): { file: MissionFile; lost: string[] } {
  if (format === 'plan')
    return { file: { name: `${name}.plan`, text: planText(mission) }, lost: [] };
  const { text, lost } = writeWaypoints(mission);
  return { file: { name: `${name}.waypoints`, text }, lost };
}

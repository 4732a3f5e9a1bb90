// What is uploaded of several chosen files: trajectories, KITTI poses joined with their times, and
// flight logs.
import type { UploadSet } from '../logs/upload_set';
import { uploadQuery, uploadSets } from '../logs/upload_set';
import { isKitti, tumFromKitti } from './kitti_times';

export type PlannedUpload =
  | { kind: 'trajectory'; name: string; body: Blob }
  /** `query` as of RestClient.uploadLog() */
  | { kind: 'log'; name: string; query: string; body: Blob };

const isLog = ({ name }: File) => /\.(tlog|bin|ulg|mcap|bag|active|lcm|log)$/i.test(name);
const isMapping = ({ name }: File) => /\.json$/i.test(name);
const isPart = ({ name }: File) => /\.(json|csv|txt)$/i.test(name);
const isTimes = ({ name }: File) => /(^|[._-])times\.txt$/i.test(name);

/** Throws an Error that names the file if files belong together of which some are missing. */
export async function uploadPlan(files: readonly File[]): Promise<PlannedUpload[]> {
  // A mapping comes with its CSV files; without one they are trajectories.
  const mapped = files.some(isMapping);
  const belongsToLog = (file: File) => isLog(file) || (mapped && isPart(file));
  const sets = uploadSets(files.filter(belongsToLog));
  if (typeof sets === 'string') throw new Error(sets);
  const trajectories = await trajectoryPlan(files.filter((file) => !belongsToLog(file)));
  return [...trajectories, ...sets.map(logPlan)];
}

function logPlan(files: UploadSet<File>): PlannedUpload {
  const [first] = files;
  const body = files.length === 1 ? first : new Blob([...files]);
  return { kind: 'log', name: first.name, query: uploadQuery(files), body };
}

async function trajectoryPlan(files: readonly File[]): Promise<PlannedUpload[]> {
  const plain = (file: File): PlannedUpload => ({
    kind: 'trajectory',
    name: file.name,
    body: file,
  });
  const times = files.filter(isTimes);
  const poses = files.filter((file) => !isTimes(file));
  const [timesFile, second] = times;
  if (timesFile === undefined) return poses.map(plain);
  if (second !== undefined)
    throw new Error(`${second.name}: one times file at a time, with its KITTI poses`);
  const stamps = await timesFile.text();
  let joined = 0;
  const plan: PlannedUpload[] = [];
  for (const file of poses) {
    const text = await file.text();
    if (!isKitti(text)) {
      plan.push(plain(file));
      continue;
    }
    joined += 1;
    const name = `${file.name.replace(/\.[^.]*$/, '')}.tum`;
    plan.push({ kind: 'trajectory', name, body: new Blob([joinedText(file, text, stamps)]) });
  }
  if (joined === 0) {
    throw new Error(`${timesFile.name}: choose the KITTI poses that it belongs to as well`);
  }
  return plan;
}

function joinedText(file: File, text: string, stamps: string): string {
  try {
    return tumFromKitti(text, stamps);
  } catch (error) {
    throw new Error(`${file.name}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

// State of the page of studies.
import type { StudyEntry, StudyLimits, StudyShown } from '../../protocol/study_types';
import type { StudyFormState } from './study_form';

export interface StudyPage {
  open: boolean;
  /** null until read. */
  studies: StudyEntry[] | null;
  limits: StudyLimits | null;
  name: string | null;
  /** null until read. */
  shown: StudyShown | null;
  error: string | null;
  /** A study that is being prepared; null = none. */
  form: StudyFormState | null;
}

export function initialStudyPage(): StudyPage {
  return {
    open: false,
    studies: null,
    limits: null,
    name: null,
    shown: null,
    error: null,
    form: null,
  };
}

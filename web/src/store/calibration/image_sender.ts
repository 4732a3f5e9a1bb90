// Sends images to a calibration of the server, one by one.
import type { CalibrationClient } from '../../connection/calibration_client';
import { errorText, RestError } from '../../connection/rest_error';
import type { Store } from '../state';

/** Before an image is offered again that the server had no room for. */
const kPause_ms = 200;

export type Later = (callback: () => void, delay_ms: number) => number;

export class ImageSender {
  /** Files that wait for the one that is being sent. */
  private unsent: File[] = [];

  constructor(
    private readonly store: Store,
    private readonly client: Pick<CalibrationClient, 'uploadImage'>,
    private readonly later: Later,
  ) {}

  /** Files chosen while others are being sent come after them; an error ends it for all. */
  async send(files: readonly File[]): Promise<void> {
    const { calibrationPage: page } = this.store.state;
    if (page.session === null || !page.session.uploads) return;
    if (page.sending !== null) {
      this.unsent.push(...files);
      page.sending.total += files.length;
      this.changed();
      return;
    }
    const { id } = page.session;
    const unsent = [...files];
    const sending = { done: 0, total: files.length };
    // Another session, or none, has other images to send.
    const isCurrent = () => page.sending === sending;
    this.unsent = unsent;
    page.sending = sending;
    this.changed();
    for (let file = unsent.shift(); file !== undefined; file = unsent.shift()) {
      try {
        await this.sendOne(id, file, isCurrent);
      } catch (error) {
        if (!isCurrent()) return;
        page.error = `${file.name}: ${errorText(error)}`;
        break;
      }
      if (!isCurrent()) return;
      sending.done += 1;
      this.changed();
    }
    page.sending = null;
    this.changed();
  }

  private async sendOne(id: string, file: File, isCurrent: () => boolean): Promise<void> {
    for (;;) {
      try {
        await this.client.uploadImage(id, file.name, file);
        return;
      } catch (error) {
        const full = error instanceof RestError && error.code === 'too_many_images';
        if (!full || !isCurrent()) throw error;
        await new Promise<void>((resolve) => this.later(resolve, kPause_ms));
      }
    }
  }

  private changed(): void {
    this.store.change('calibration');
  }
}

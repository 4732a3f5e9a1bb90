// The steps of one session: after one that failed the others would only wait in vain.
import { it } from 'node:test';

/** @param dashboard gives the dashboard, once there is one, for a screenshot of a failure */
export function makeStep(dashboard) {
  let broken = false;
  return (name, body) =>
    it(name, async (t) => {
      if (broken) {
        t.skip('an earlier step failed');
        return;
      }
      broken = true;
      try {
        await body(t);
      } catch (error) {
        await dashboard()?.screenshot('failed');
        throw error;
      }
      broken = false;
    });
}

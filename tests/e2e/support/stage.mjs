// What a session needs: a server with its run folders, a browser, the dashboard in it.
import { openBrowser } from './browser.mjs';
import { Dashboard } from './dashboard.mjs';
import { makeRunsFolder, startServer } from './server.mjs';

/**
 * @param size of the browser's window [px]
 * @param prepare is given the run folders before the server starts; its answer are further options
 *   of the server
 */
export async function openStage(size, prepare = () => ({})) {
  const stage = { runs: makeRunsFolder() };
  stage.close = async () => {
    await stage.browser?.close();
    await stage.server?.stop();
    stage.runs.remove();
  };
  try {
    const { folder: runs, tokenFile } = stage.runs;
    stage.server = await startServer({ runs, tokenFile, ...prepare(runs) });
    stage.browser = await openBrowser(size);
    stage.dashboard = new Dashboard(stage.browser.page);
    await stage.dashboard.open(stage.server.address);
  } catch (error) {
    await stage.close();
    throw error;
  }
  return stage;
}

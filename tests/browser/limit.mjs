// How long a test waits: for an event, and at most until it fails.

// What Playwright takes for the time after which a wait has failed.
export const limit = { timeout: 600_000 };

export const pause = (milliseconds = 50) => new Promise((resolve) => setTimeout(resolve, milliseconds));

// Waits until something holds, and gives it.
export async function until(what, holds) {
  const end = Date.now() + limit.timeout;
  for (;;) {
    const it = await holds();
    if (it) return it;
    if (Date.now() > end) throw new Error(`waited for ${what} in vain`);
    await pause();
  }
}

/** Which pins stand on the timeline. Pure. */
import type { Thread } from "@/api/types";

export interface MomentPin {
  readonly t_s: number;
  readonly threads: readonly Thread[];
  readonly unread: number;
}

/** Parts of the timeline's width that a pin takes at least. */
const APART = 1 / 30;

/** The pins of threads that are open, given in the order of their moments; near ones are gathered at the first. */
export function pinsOnTimeline(
  threads: readonly { readonly thread: Thread; readonly t_s: number }[],
  span_s: number,
): MomentPin[] {
  const pins: MomentPin[] = [];
  for (const { thread, t_s } of threads) {
    if (thread.resolved_at !== null) continue;
    const last = pins.at(-1);
    if (last && t_s - last.t_s < span_s * APART)
      pins[pins.length - 1] = {
        t_s: last.t_s,
        threads: [...last.threads, thread],
        unread: last.unread + thread.unread,
      };
    else pins.push({ t_s, threads: [thread], unread: thread.unread });
  }
  return pins;
}

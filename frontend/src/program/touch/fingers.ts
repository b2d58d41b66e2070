/** The fingers on the screen: the last thing that pressed was one, and whether more than one presses. */
import { useEffect } from "react";
import { create } from "zustand";

interface Fingers {
  /** The last press was a finger's: then one finger pans, and nothing is boxed. */
  readonly touching: boolean;
  /** More than one finger has been down since the first: whatever the first one began is given up. */
  readonly several: boolean;
}

export const useFingers = create<Fingers>(() => ({ touching: false, several: false }));

type Press = Pick<PointerEvent, "pointerId" | "pointerType">;

/** Takes presses and their ends; each screen has one. */
export class FingerCount {
  readonly #down = new Set<number>();

  press({ pointerId, pointerType }: Press): void {
    if (pointerType !== "touch") {
      useFingers.setState({ touching: false, several: false });
      return;
    }
    this.#down.add(pointerId);
    useFingers.setState({ touching: true, several: this.#down.size > 1 });
  }

  /** `several` stays until the next first finger: what the last one lifts has been begun by two. */
  lift({ pointerId }: Press): void {
    this.#down.delete(pointerId);
  }
}

/** Counts before the map hears of the press, so that it means what the fingers say. */
export function useFingerCount(): void {
  useEffect(() => {
    const count = new FingerCount();
    const press = (event: PointerEvent) => count.press(event);
    const lift = (event: PointerEvent) => count.lift(event);
    window.addEventListener("pointerdown", press, { capture: true });
    window.addEventListener("pointerup", lift, { capture: true });
    window.addEventListener("pointercancel", lift, { capture: true });
    return () => {
      window.removeEventListener("pointerdown", press, { capture: true });
      window.removeEventListener("pointerup", lift, { capture: true });
      window.removeEventListener("pointercancel", lift, { capture: true });
    };
  }, []);
}

/** The live region of the editor. A text that stays as it is is not read again, so that two regions take turns. */
import { useSaid } from "./announcer";

export function Announcer() {
  const { text, turn } = useSaid();
  return (
    <div className="visually-hidden" data-announcer>
      <div aria-live="polite">{turn % 2 === 0 ? text : ""}</div>
      <div aria-live="polite">{turn % 2 === 1 ? text : ""}</div>
    </div>
  );
}

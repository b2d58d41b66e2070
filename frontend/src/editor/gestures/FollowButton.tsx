/** A person in the top bar: a press follows their view, a second one stops. */
import { Avatar } from "@/design/Avatar";
import { useOpenProgram } from "../state/context";
import type { Person } from "../state/presence";
import classes from "./gestures.module.css";
import { useGestures } from "./store";

export function FollowButton({ person }: { person: Person }) {
  const { t } = useOpenProgram();
  const follows = useGestures((ui) => ui.following === person.client);
  const label = t(follows ? "gesture.follow.stop" : "gesture.follow.start", { name: person.name });
  return (
    <button
      type="button"
      className={classes.follow}
      aria-pressed={follows}
      aria-label={label}
      title={label}
      onClick={() => useGestures.setState({ following: follows ? null : person.client })}
    >
      <Avatar name={person.name} initials={person.initials} colour={person.colour} live />
    </button>
  );
}

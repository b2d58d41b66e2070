/** A person in the top bar: a press follows their view, a second one stops. */
import { useReducedMotion } from "@mantine/hooks";
import { Avatar } from "@/design/Avatar";
import { useOpenProgram } from "../state/context";
import type { Person } from "../state/presence";
import { say } from "../state/ui";
import classes from "../canvas/gestures.module.css";
import { useGestures } from "../state/gestures";

export function FollowButton({ person }: { person: Person }) {
  const { t } = useOpenProgram();
  const follows = useGestures((ui) => ui.following === person.client);
  const still = useReducedMotion();
  const label = t(follows ? "gesture.follow.stop" : "gesture.follow.start", { name: person.name });
  const picture = (title?: string) => (
    <Avatar name={person.name} initials={person.initials} colour={person.colour} live title={title} />
  );
  if (still) return picture(person.name);
  const press = () => {
    useGestures.setState({ following: follows ? null : person.client });
    if (!follows) say(t("gesture.follow.now", { name: person.name }));
  };
  return (
    <button
      type="button"
      className={classes.follow}
      aria-pressed={follows}
      aria-label={`${person.initials}: ${label}`}
      title={label}
      onClick={press}
    >
      {picture()}
    </button>
  );
}

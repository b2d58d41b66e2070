/** The constructs that a program uses, as a row of their icons. */
import { useTranslation } from "react-i18next";
import type { StepKind } from "@/api/types";
import { VipoIcon } from "@/map/VipoIcon";
import styles from "./pages.module.css";

const ICONS: Readonly<Record<StepKind, [icon: string, colour: string]>> = {
  move: ["move", "var(--motion)"],
  pick: ["pick", "var(--motion)"],
  drop: ["drop", "var(--motion)"],
  pick_and_drop: ["pickdrop", "var(--motion)"],
  operate: ["operate", "var(--machine)"],
  wait: ["wait", "var(--machine)"],
  if: ["if", "var(--logic)"],
  while: ["while", "var(--logic)"],
  parallel: ["parallel", "var(--logic)"],
  try: ["try", "var(--logic)"],
  call: ["fn", "var(--func)"],
};

export function StepIcons({ kinds }: { kinds: readonly StepKind[] }) {
  const { t } = useTranslation();
  return (
    <ul className={styles.kinds} aria-label={t("pages.stepsUsed")}>
      {kinds.slice(0, 8).map((kind) => {
        const [icon, colour] = ICONS[kind] ?? ["fn", "var(--func)"];
        const name = t(`pages.kind.${kind}`);
        return (
          <li key={kind} title={name} style={{ color: colour }}>
            <VipoIcon name={icon} size={15} />
            <span className="visually-hidden">{name}</span>
          </li>
        );
      })}
    </ul>
  );
}

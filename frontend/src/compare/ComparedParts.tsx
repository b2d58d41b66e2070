/** What every comparison on a map is made of: its frame, the change that is chosen, the map. */
import { type ReactNode, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import type { Comparison, ConstructChange } from "@/api/types";
import type { FloorPlan } from "@/map/floor/floor";
import type { SiteDevice } from "@/program/surroundings";
import { TopBar } from "@/shell/TopBar";
import { CompareMap } from "./CompareMap";
import styles from "./compare.module.css";
import { keyOf, neighbour, spotOf } from "./marks";
import { NOTHING, type Pictures } from "./usePictures";

export function Frame({ children, waiting }: { children?: ReactNode; waiting?: boolean }) {
  const { t } = useTranslation();
  return (
    <div className={styles.screen}>
      <TopBar site={undefined} />
      <main className={styles.loading} role={waiting ? "status" : undefined}>
        {waiting ? t("compare.loading") : children}
      </main>
    </div>
  );
}

/** What is chosen, and how often: choosing it once more brings it into sight again. */
export function useChoice(changes: readonly ConstructChange[]) {
  const [choice, setChoice] = useState<{ key: string | null; round: number }>({ key: null, round: 0 });
  const order = useMemo(() => changes.map(keyOf), [changes]);
  const chosen = choice.key !== null && order.includes(choice.key) ? choice.key : null;
  const choose = (key: string | null) => setChoice(({ round }) => ({ key, round: round + 1 }));
  return {
    order,
    chosen,
    round: choice.round,
    choose,
    walk: (by: 1 | -1) => choose(neighbour(order, chosen, by)),
    change: changes.find((each) => keyOf(each) === chosen) ?? null,
  };
}

interface MapOfProps {
  plan: FloorPlan | null;
  devices: readonly SiteDevice[];
  comparison: Comparison | undefined;
  pictures: Pictures;
  choice: ReturnType<typeof useChoice>;
  /** Both sides are one version. */
  isOne?: boolean;
}

export function MapOf({ plan, devices, comparison, pictures, choice, isOne = false }: MapOfProps) {
  const { t } = useTranslation();
  const { change, chosen, round } = choice;
  return (
    <section className={styles.map} aria-label={t("compare.map")}>
      {comparison ? (
        <CompareMap
          plan={plan}
          devices={devices}
          difference={comparison.difference ?? NOTHING}
          isOne={isOne}
          pictures={pictures}
          chosen={chosen}
          round={round}
          spot={change ? spotOf(change, pictures.old.scene, pictures.new.scene) : null}
          label={t("compare.map")}
          onChoose={choice.choose}
        />
      ) : (
        <p className={styles.loading} role="status">
          {t("compare.loading")}
        </p>
      )}
    </section>
  );
}

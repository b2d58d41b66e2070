/** What would mend a finding of the floor check, for who may change the map: a press does it, another takes it back. */
import { Button, Loader } from "@mantine/core";
import { Move, SquareDashed } from "lucide-react";
import { useTranslation } from "react-i18next";
import { useRemedies } from "@/api/floorCheck";
import { useDevices } from "@/api/queries";
import type { FloorFinding, SiteMap } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import places from "../places/places.module.css";
import styles from "./check.module.css";
import { byZone, metres } from "./findingWords";
import type { FloorCheckView } from "./useFloorCheckView";
import { useMoves } from "./useMoves";

interface RemediesProps {
  slug: string;
  map: SiteMap;
  finding: FloorFinding;
  nameOf: (id: string) => string;
  view: FloorCheckView;
  /** Changes the zones of the map, this one first. */
  editZone: (zone: string | null) => void;
  leave: () => void;
}

export function Remedies(props: RemediesProps) {
  const { finding, editZone } = props;
  const { t } = useTranslation();
  const isByZone = byZone(finding);
  return (
    <div className={styles.remedies}>
      {isByZone ? (
        <Button
          size="xs"
          variant="default"
          leftSection={<SquareDashed size={14} aria-hidden="true" />}
          onClick={() => editZone(finding.other)}
        >
          {finding.other === null
            ? t("floorCheck.remedy.zones")
            : t("floorCheck.remedy.zone", { zone: props.nameOf(finding.other) })}
        </Button>
      ) : (
        <Moves {...props} />
      )}
    </div>
  );
}

function Moves({ slug, map, finding, nameOf, view, leave }: RemediesProps) {
  const { t } = useTranslation();
  const devices = useDevices(slug).data ?? [];
  const {
    data: remedies,
    error,
    isFetching,
    refetch,
  } = useRemedies(slug, map, devices, finding, {
    width_m: view.asked,
    enabled: !view.isChecking, // a finding of before may be gone
  });
  const { move, isMoving } = useMoves(slug, map, devices);
  if (error)
    return (
      <>
        <p role="alert" className={styles.failed}>
          {problemText(error, t("floorCheck.remedy.failed"))}
        </p>
        <Button size="xs" variant="default" onClick={() => void refetch()}>
          {t("shell.problem.again")}
        </Button>
      </>
    );
  if (!remedies || isFetching)
    return (
      <p className={places.quiet} role="status">
        <Loader size={12} aria-hidden="true" /> {t("floorCheck.remedy.looking")}
      </p>
    );
  if (remedies.length === 0) return <p className={places.quiet}>{t("floorCheck.remedy.none")}</p>;
  return remedies.map((remedy, index) => (
    <Button
      key={remedy.target}
      size="xs"
      variant={index === 0 ? "filled" : "default"}
      leftSection={<Move size={14} aria-hidden="true" />}
      disabled={isMoving}
      onClick={() => {
        leave();
        move(remedy, nameOf(remedy.target));
      }}
      onPointerEnter={() => view.setGhost(remedy)}
      onPointerLeave={() => view.setGhost(null)}
      onFocus={() => view.setGhost(remedy)}
      onBlur={() => view.setGhost(null)}
    >
      {t("floorCheck.remedy.move", { name: nameOf(remedy.target), by: metres(remedy.by_m) })}
    </Button>
  ));
}

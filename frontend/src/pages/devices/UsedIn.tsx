/** The programs that name a device. */
import { Skeleton } from "@mantine/core";
import { Workflow } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { usePrograms } from "@/api/queries";
import { LoadProblem } from "@/shell/LoadProblem";
import { EmptyState } from "@/design/EmptyState";
import { Panel } from "@/design/Panel";
import { Soundness } from "../programs/ProgramTable";
import styles from "./detail.module.css";

/** The programs of a site that name the device; `found` is null until that is known. */
export function useUsedIn(slug: string, device: string) {
  const programs = usePrograms(slug);
  return { ...programs, found: programs.data?.filter((program) => program.devices.includes(device)) ?? null };
}

export function UsedIn({ slug, device }: { slug: string; device: string }) {
  const { t } = useTranslation();
  const { found, isError, error, refetch } = useUsedIn(slug, device);
  if (isError) return <LoadProblem error={error} again={() => void refetch()} />;
  if (!found) return <Skeleton height={120} />;
  if (found.length === 0)
    return (
      <Panel>
        <EmptyState icon={<Workflow size={20} />} title={t("adding.usedNone")} text={t("adding.usedNoneText")} />
      </Panel>
    );
  return (
    <Panel>
      <ul className={styles.used}>
        {found.map((program) => (
          <li key={program.id}>
            <Link to={`/programs/${program.id}`}>{program.name}</Link>
            <Soundness program={program} />
          </li>
        ))}
      </ul>
    </Panel>
  );
}

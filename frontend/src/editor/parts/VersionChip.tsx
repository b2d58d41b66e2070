/** The program's last version; a press leads to its history, where versions are compared and restored. */
import { History } from "lucide-react";
import { Link } from "react-router-dom";
import { useVersions } from "@/api/queries";
import { Chip } from "@/design/Chip";
import { useOpenProgram } from "../state/context";
import classes from "./top.module.css";

export function VersionChip() {
  const { program, site, t } = useOpenProgram();
  const newest = useVersions(program.id).data?.pages[0]?.items[0]?.number;
  const words = newest ? t("versions.newest", { number: newest }) : t("versions.none");
  return (
    <Link
      className={classes.versions}
      to={
        newest ? `/programs/${program.id}/compare?old=${newest}&new=draft` : `/sites/${site.slug}/history/${program.id}`
      }
      title={t("versions.label")}
    >
      <Chip tone="plain">
        <History size={14} aria-hidden="true" />
        <span className={newest ? undefined : classes.words}>{words}</span>
        <span className="visually-hidden">{t("versions.label")}</span>
      </Chip>
    </Link>
  );
}

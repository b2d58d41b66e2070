/** To where the map itself is changed. */
import { Button } from "@mantine/core";
import { PencilRuler } from "lucide-react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import styles from "./MapPage.module.css";

export function EditMapButton({ slug }: { slug: string }) {
  const { t } = useTranslation();
  return (
    <Button
      component={Link}
      to={`/sites/${slug}/map/edit`}
      variant="default"
      title={t("mapEdit.edit")}
      classNames={{ label: styles.actionLabel ?? "", section: styles.actionIcon ?? "" }}
      leftSection={<PencilRuler size={16} aria-hidden="true" />}
    >
      {t("mapEdit.edit")}
    </Button>
  );
}

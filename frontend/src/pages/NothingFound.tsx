import { Button } from "@mantine/core";
import { SearchX } from "lucide-react";
import { useTranslation } from "react-i18next";
import { EmptyState } from "@/design/EmptyState";

/** A search without a result, and the way out. */
export function NothingFound({ clear }: { clear: () => void }) {
  const { t } = useTranslation();
  return (
    <EmptyState icon={<SearchX size={20} />} title={t("pages.nothingFound")}>
      <Button variant="default" onClick={clear}>
        {t("pages.clearFilters")}
      </Button>
    </EmptyState>
  );
}
